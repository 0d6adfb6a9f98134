#include "mesh/io/ply_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/interrupt.h"
#include "mesh/io/mesh_text.h"

namespace meshwind {
namespace {

constexpr std::size_t kMaxHeaderLines = 1000;

struct TypeName {
    std::string_view name;
    PlyType type;
};
constexpr std::array<TypeName, 16> kTypes = {{{"char", PlyType::Int8},
                                              {"int8", PlyType::Int8},
                                              {"uchar", PlyType::Uint8},
                                              {"uint8", PlyType::Uint8},
                                              {"short", PlyType::Int16},
                                              {"int16", PlyType::Int16},
                                              {"ushort", PlyType::Uint16},
                                              {"uint16", PlyType::Uint16},
                                              {"int", PlyType::Int32},
                                              {"int32", PlyType::Int32},
                                              {"uint", PlyType::Uint32},
                                              {"uint32", PlyType::Uint32},
                                              {"float", PlyType::Float32},
                                              {"float32", PlyType::Float32},
                                              {"double", PlyType::Float64},
                                              {"float64", PlyType::Float64}}};

std::size_t bytes_of(PlyType type) {
    switch (type) {
        case PlyType::Int8:
        case PlyType::Uint8:
            return 1;
        case PlyType::Int16:
        case PlyType::Uint16:
            return 2;
        case PlyType::Float64:
            return 8;
        default:
            return 4;
    }
}

bool is_float(PlyType type) {
    return type == PlyType::Float32 || type == PlyType::Float64;
}

class HeaderReader {
public:
    HeaderReader(std::string_view bytes, const std::string& file)
        : bytes_(bytes), text_(bytes, file) {}

    PlyHeader read() {
        if (bytes_.substr(0, 3) != "ply" || !text_.next_line() || text_.word() != "ply") {
            refuse("has no PLY header");
        }
        while (read_line()) {
        }
        if (!format_known_) {
            refuse("has no line 'format ascii 1.0' or 'format binary_little_endian 1.0'");
        }
        header_.bytes = std::min(text_.offset() + line_end_bytes(), bytes_.size());
        header_.lines = text_.line();
        for (const PlyElement& element : header_.elements) {
            check_rows(element);
        }
        return std::move(header_);
    }

private:
    [[noreturn]] void refuse(const std::string& message) const {
        text_.refuse("mesh.not_a_mesh", message + "; export the part again");
    }

    // \return false behind the last line
    bool read_line() {
        if (!text_.next_line() || text_.line() > static_cast<std::int64_t>(kMaxHeaderLines)) {
            refuse("its header has no line 'end_header'");
        }
        const std::string_view keyword = text_.word();
        if (keyword == "end_header") {
            return false;
        }
        if (keyword == "format") {
            read_format();
        } else if (keyword == "element") {
            read_element();
        } else if (keyword == "property") {
            read_property();
        } else if (keyword != "comment" && keyword != "obj_info") {
            refuse("has " + shown(keyword) + " in its header, which is no keyword of PLY files");
        }
        return true;
    }

    void read_format() {
        const std::string_view name = text_.word();
        format_known_ = true;
        if (name == "ascii") {
            header_.format = PlyFormat::Text;
        } else if (name == "binary_little_endian") {
            header_.format = PlyFormat::LittleEndian;
        } else if (name == "binary_big_endian") {
            header_.format = PlyFormat::BigEndian;
        } else {
            refuse("has the format " + shown(name) +
                   ", known are ascii, binary_little_endian and binary_big_endian");
        }
    }

    void read_element() {
        PlyElement element;
        element.name = text_.word();
        const std::string_view word = text_.word();
        std::int64_t rows = 0;
        if (element.name.empty() || !parse_integer(word, rows) || rows < 0) {
            refuse("has " + shown(word) + " in place of the number of an element's rows");
        }
        const auto same = [&](const PlyElement& other) { return other.name == element.name; };
        if (std::any_of(header_.elements.begin(), header_.elements.end(), same)) {
            refuse("has the element " + shown(element.name) + " twice");
        }
        element.rows = static_cast<std::size_t>(rows);
        header_.elements.push_back(std::move(element));
    }

    void read_property() {
        PlyProperty property;
        std::string_view word = text_.word();
        if (word == "list") {
            property.list = true;
            property.count_type = type_of(text_.word());
            if (is_float(property.count_type)) {
                refuse("has a list whose length is no whole number");
            }
            word = text_.word();
        }
        property.type = type_of(word);
        property.name = text_.word();
        if (property.name.empty() || header_.elements.empty()) {
            refuse("has a property without a name or before all elements");
        }
        header_.elements.back().properties.push_back(std::move(property));
    }

    PlyType type_of(std::string_view word) const {
        const auto* const found =
            std::find_if(kTypes.begin(), kTypes.end(),
                         [&](const TypeName& known) { return known.name == word; });
        if (found == kTypes.end()) {
            refuse("has " + shown(word) + " in place of a type such as float or int");
        }
        return found->type;
    }

    // As the first line ends, so does the last: behind it the first byte may be any.
    [[nodiscard]] std::size_t line_end_bytes() const {
        return bytes_.substr(3, 2) == "\r\n" ? 2 : 1;
    }

    void check_rows(const PlyElement& element) const {
        if (element.properties.empty() && element.rows > 0) {
            refuse("has the element " + shown(element.name) + " without a property");
        }
        std::size_t row = 0;
        for (const PlyProperty& property : element.properties) {
            const bool binary = header_.format != PlyFormat::Text;
            row += !binary ? 2 : bytes_of(property.list ? property.count_type : property.type);
        }
        // The last row of a text may lack the end of its line.
        const std::size_t left = bytes_.size() - header_.bytes + 1;
        if (element.rows > 0 && element.rows > left / row) {
            text_.refuse("mesh.truncated", "announces " + std::to_string(element.rows) +
                                               " rows of " + shown(element.name) +
                                               ", which the file is too short for; export or copy "
                                               "the file again");
        }
    }

    std::string_view bytes_;
    MeshText text_;
    PlyHeader header_;
    bool format_known_ = false;
};

class TextValues : public PlyValues {
public:
    TextValues(std::string_view bytes, const std::string& file, const PlyHeader& header)
        : text_(bytes, file, {.skip = header.bytes, .lines_before = header.lines}) {}

    void begin_row() override {
        if (!text_.next_line()) {
            text_.refuse("mesh.truncated",
                         "ends before all rows that its header announces; export or copy the file "
                         "again");
        }
    }
    double number(PlyType) override { return text_.number("a row's numbers"); }
    std::int64_t integer(PlyType) override { return text_.integer("a count or an index"); }
    void end_row() override {
        if (const std::string_view more = text_.word(); !more.empty()) {
            text_.refuse("mesh.bad_line", shown(more) +
                                              " is one value too many for the properties "
                                              "in the header; export the part again");
        }
    }
    [[noreturn]] void refuse(const std::string& code, const std::string& message) const override {
        text_.refuse(code, message);
    }

private:
    MeshText text_;
};

class BinaryValues : public PlyValues {
public:
    BinaryValues(std::string_view bytes, std::string file, const PlyHeader& header)
        : bytes_(bytes),
          file_(std::move(file)),
          at_(header.bytes),
          swapped_((header.format == PlyFormat::BigEndian) ==
                   (std::endian::native == std::endian::little)) {}

    void begin_row() override {
        constexpr std::size_t kRowsPerCheck = 16384;
        if (++rows_ % kRowsPerCheck == 0) {
            check_interrupt();
        }
    }
    double number(PlyType type) override {
        switch (type) {
            case PlyType::Float32:
                return static_cast<double>(take<float>());
            case PlyType::Float64:
                return take<double>();
            default:
                return static_cast<double>(integer(type));
        }
    }
    std::int64_t integer(PlyType type) override {
        switch (type) {
            case PlyType::Int8:
                return take<std::int8_t>();
            case PlyType::Uint8:
                return take<std::uint8_t>();
            case PlyType::Int16:
                return take<std::int16_t>();
            case PlyType::Uint16:
                return take<std::uint16_t>();
            case PlyType::Int32:
                return take<std::int32_t>();
            case PlyType::Uint32:
                return take<std::uint32_t>();
            default:
                refuse("mesh.not_a_mesh",
                       "has indices that are no whole numbers; export the part again");
        }
    }
    void end_row() override {}
    [[noreturn]] void refuse(const std::string& code, const std::string& message) const override {
        throw InputError(code, file_ + ", byte " + std::to_string(at_), message);
    }

private:
    template <typename T>
    T take() {
        std::array<char, sizeof(T)> raw{};
        if (bytes_.size() - at_ < raw.size()) {
            refuse("mesh.truncated",
                   "ends before all rows that its header announces; export or copy the file again");
        }
        std::copy_n(bytes_.data() + at_, raw.size(), raw.begin());
        at_ += raw.size();
        if (swapped_) {
            std::reverse(raw.begin(), raw.end());
        }
        return std::bit_cast<T>(raw);
    }

    std::string_view bytes_;
    std::string file_;
    std::size_t at_;
    bool swapped_;
    std::size_t rows_ = 0;
};

}  // namespace

PlyHeader read_ply_header(std::string_view bytes, const std::string& file) {
    return HeaderReader(bytes, file).read();
}

std::unique_ptr<PlyValues> ply_values(std::string_view bytes, const std::string& file,
                                      const PlyHeader& header) {
    if (header.format == PlyFormat::Text) {
        return std::make_unique<TextValues>(bytes, file, header);
    }
    return std::make_unique<BinaryValues>(bytes, file, header);
}

}  // namespace meshwind
