# cmake -D IN=page.html -D OUT=source.cpp -D NAME=function -P embed.cmake: a text file as a C++ string.
file(READ ${IN} page)
file(
    WRITE ${OUT}
    "#include \"report/page/packed_page.h\"\n\nstd::string_view meshwind::${NAME}() {\n    return R\"meshwind~(${page})meshwind~\";\n}\n")
