#include <algorithm>
#include <cctype>

#include "core/error.h"
#include "mesh/io/mesh_readers.h"
#include "mesh/io/mesh_text.h"

namespace meshwind {
namespace {

bool is_word(std::string_view word, std::string_view lower_case) {
    return word.size() == lower_case.size() &&
           std::equal(word.begin(), word.end(), lower_case.begin(), [](char a, char b) {
               return std::tolower(static_cast<unsigned char>(a)) == b;
           });
}

std::string_view last_line(std::string_view bytes) {
    const std::size_t end = bytes.find_last_not_of(" \t\r\n");
    if (end == std::string_view::npos) {
        return {};
    }
    bytes = bytes.substr(0, end + 1);
    const std::size_t start = bytes.find_last_of("\r\n");
    bytes = start == std::string_view::npos ? bytes : bytes.substr(start + 1);
    return bytes.substr(std::min(bytes.find_first_not_of(" \t"), bytes.size()));
}

class StlReader {
public:
    StlReader(std::string_view bytes, const std::string& file)
        : bytes_(bytes), file_(file), text_(bytes, file) {}

    PolygonSoup read() {
        check_end();
        for (std::string_view word = text_.word_of_text(); !word.empty();
             word = text_.word_of_text()) {
            if (is_word(word, "facet")) {
                read_facet();
            } else if (is_word(word, "solid") || is_word(word, "endsolid")) {
                text_.pass_line();  // a name, which may be any words
            } else {
                expect("facet", word);
            }
        }
        return std::move(soup_);
    }

private:
    void check_end() const {
        const std::string_view end = last_line(bytes_);
        if (!is_word(end.substr(0, 8), "endsolid") && !is_word(end.substr(0, 8), "endfacet")) {
            throw InputError("mesh.truncated", file_,
                             "the text ends inside a facet, export or copy the file again");
        }
    }

    // The normal is not used: some exporters leave it out or write nan.
    void read_facet() {
        constexpr int kNormalWords = 4;  // "normal" and three numbers
        std::string_view word = text_.word_of_text();
        for (int i = 0; i < kNormalWords && !is_word(word, "outer"); ++i) {
            word = text_.word_of_text();
        }
        expect("outer", word);
        expect("loop", text_.word_of_text());
        for (int corner = 0; corner < 3; ++corner) {
            expect("vertex", text_.word_of_text());
            read_point();
        }
        expect("endloop", text_.word_of_text());
        expect("endfacet", text_.word_of_text());
        soup_.ends.push_back(soup_.corners.size());
    }

    void read_point() {
        Eigen::Vector3d point;
        for (double& x : point) {
            x = text_.number("the coordinates of a corner");
        }
        soup_.corners.push_back(static_cast<std::int32_t>(soup_.points.size()));
        soup_.points.push_back(point);
    }

    void expect(std::string_view wanted, std::string_view word) const {
        if (!is_word(word, wanted)) {
            text_.refuse("mesh.bad_line", shown(word) + " stands where " + std::string(wanted) +
                                              " is wanted; export the part again");
        }
    }

    std::string_view bytes_;
    std::string file_;
    MeshText text_;
    PolygonSoup soup_;
};

}  // namespace

PolygonSoup read_text_stl(std::string_view bytes, const std::string& file) {
    return StlReader(bytes, file).read();
}

}  // namespace meshwind
