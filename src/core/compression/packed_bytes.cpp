#include "core/compression/packed_bytes.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace vorotool::core::compression {
namespace {

constexpr unsigned clear_code = 256, end_code = 257, first_code = 258, most_codes = 4096;
constexpr unsigned narrow = 9, wide = 12;  // bits of a code

// Codes of 9 to 12 bits, the highest bit first.
class CodeReader {
 public:
  explicit CodeReader(std::span<const std::uint8_t> data) : data_(data) {}

  // The next code; end_code where fewer bits are left: many writers leave out the last code.
  unsigned next(unsigned width) {
    while (held_ < width) {
      if (at_ == data_.size()) return end_code;
      bits_ = bits_ << 8 | data_[at_++];
      held_ += 8;
    }
    held_ -= width;
    return bits_ >> held_ & ((1U << width) - 1);
  }

 private:
  std::span<const std::uint8_t> data_;
  std::size_t at_ = 0;
  std::uint32_t bits_ = 0;  // the last `held_` of them are not yet read
  unsigned held_ = 0;
};

// The texts of codes. Each text but those of one byte has been written before: it is kept as its place in the
// output, and so no text is longer than what is written.
class LzwTexts {
 public:
  LzwTexts(std::vector<std::uint8_t>& out, std::size_t limit) : out_(out), limit_(limit) {}

  void clear() {
    next_ = first_code;
    width_ = narrow;
    last_ = {0, 0};
  }

  unsigned width() const { return width_; }

  // Writes the text of a code, and gives the next code to the text before it and its first byte.
  void write(unsigned code) {
    const bool learns = last_.size > 0 && next_ < most_codes;
    if (learns) texts_[next_++] = {last_.start, last_.size + 1};  // its last byte is about to be written
    const Text written{out_.size(), code < clear_code ? 1 : text_of(code).size};
    if (code < clear_code) {
      out_.push_back(static_cast<std::uint8_t>(code));
    } else {
      copy(text_of(code));
    }
    last_ = written;
    if (next_ + 1 >= 1U << width_ && width_ < wide) ++width_;  // TIFF changes one code early
  }

 private:
  struct Text {
    std::size_t start, size;
  };

  Text text_of(unsigned code) const {
    if (code >= next_) throw DamagedCode("code " + std::to_string(code) + " stands for nothing yet");
    return texts_[code];
  }

  // Byte by byte, for a text may end in the byte that is its first: the one written last.
  void copy(Text text) {
    const std::size_t size = std::min(text.size, limit_ - std::min(limit_, out_.size()));
    const std::size_t end = out_.size();
    out_.resize(end + size);
    for (std::size_t i = 0; i < size; ++i) out_[end + i] = out_[text.start + i];
  }

  std::vector<std::uint8_t>& out_;
  std::size_t limit_;
  std::array<Text, most_codes> texts_{};  // of first_code to next_ - 1
  unsigned next_ = first_code, width_ = narrow;
  Text last_{0, 0};  // without size right after clear_code
};

}  // namespace

std::vector<std::uint8_t> unpack_lzw(std::span<const std::uint8_t> data, std::size_t limit,
                                     const base::Monitor& monitor) {
  std::vector<std::uint8_t> out;
  LzwTexts texts(out, limit);
  CodeReader codes(data);
  for (std::size_t item = 1; out.size() < limit; ++item) {
    base::report_item(monitor, item);
    const unsigned code = codes.next(texts.width());
    if (code == end_code) break;
    if (code == clear_code) {
      texts.clear();
    } else {
      texts.write(code);
    }
  }
  return out;
}

std::vector<std::uint8_t> unpack_packbits(std::span<const std::uint8_t> data, std::size_t limit,
                                          const base::Monitor& monitor) {
  std::vector<std::uint8_t> out;
  std::size_t item = 0;
  for (std::size_t at = 0; at < data.size() && out.size() < limit;) {
    base::report_item(monitor, ++item);
    const std::size_t length = data[at++];
    const std::size_t room = limit - out.size(), left = data.size() - at;
    if (length < 128) {  // so many literals and one more
      const std::size_t size = std::min(length + 1, left);
      out.insert(out.end(), data.begin() + static_cast<std::ptrdiff_t>(at),
                 data.begin() + static_cast<std::ptrdiff_t>(at + std::min(size, room)));
      at += size;
    } else if (length > 128 && left > 0) {  // 128 is nothing
      out.insert(out.end(), std::min(257 - length, room), data[at++]);
    }
  }
  return out;
}

}  // namespace vorotool::core::compression
