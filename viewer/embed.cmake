# cmake -D IN=page.html -D OUT=page_template.cpp -P embed.cmake: a text file as a C++ string.
file(READ ${IN} page)
file(
    WRITE ${OUT}
    "#include \"report/report_page.h\"\n\nstd::string_view meshwind::page_template() {\n    return R\"meshwind~(${page})meshwind~\";\n}\n")
