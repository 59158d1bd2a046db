#pragma once

#include <gtest/gtest.h>

#include <array>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace tribofit {

/// What stands in an SVG that PictureFiles wrote.

using boost::property_tree::ptree;

inline ptree parsed(const std::string& svg) {
  std::istringstream in(svg);
  ptree tree;
  boost::property_tree::read_xml(in, tree);  // throws where it is not well-formed
  return tree;
}

inline void append_text(const ptree& node, std::string& out) {
  out += node.data();
  for (const auto& [name, child] : node) {
    if (name != "<xmlattr>") append_text(child, out);
  }
}

struct Word {
  std::string text;
  double x = 0, y = 0;
};
inline double node_at(const ptree& node, const char* name) {
  return node.get<double>(std::string("<xmlattr>.") + name, 0);  // 0: it stands upright, elsewhere
}
/// Every <text> with its place.
inline void collect_words(const ptree& node, std::vector<Word>& words) {
  for (const auto& [name, child] : node) {
    if (name == "text") {
      Word word;
      append_text(child, word.text);
      word.x = node_at(child, "x");
      word.y = node_at(child, "y");
      words.push_back(word);
    }
    collect_words(child, words);
  }
}
inline std::vector<Word> words_of(const std::string& svg) {
  std::vector<Word> words;
  collect_words(parsed(svg), words);
  return words;
}
inline std::vector<std::string> texts_of(const std::string& svg) {
  std::vector<std::string> texts;
  for (const Word& word : words_of(svg)) texts.push_back(word.text);
  return texts;
}
/// The lowest on paper, where numbers of the abscissa stand.
inline Word word(const std::string& svg, const std::string& text) {
  Word found;
  for (const Word& one : words_of(svg)) {
    if (one.text == text && one.y >= found.y) found = one;
  }
  EXPECT_EQ(found.text, text);
  return found;
}

/// What is plotted, without axes and legend.
inline std::string plotted(const std::string& svg) {
  const std::string begin = "<g class=\"plot\"", end = "</g>";
  std::string found;
  for (std::size_t at = svg.find(begin); at != std::string::npos; at = svg.find(begin, at + 1)) {
    found += svg.substr(at, svg.find(end, at) - at);
  }
  return found;
}

/// Points of all that is plotted as lines in this colour, as "#0072b2".
inline std::vector<std::array<double, 2>> path_in(const std::string& svg, const std::string& colour) {
  const std::string drawn = plotted(svg), begin = "<path fill=\"none\" stroke=\"" + colour + "\"", data = " d=\"";
  std::string all;
  for (std::size_t at = drawn.find(begin); at != std::string::npos; at = drawn.find(begin, at + 1)) {
    const std::size_t from = drawn.find(data, at) + data.size();
    all += drawn.substr(from, drawn.find('"', from) - from) + " ";
  }
  for (char& c : all) {
    if (c == 'M' || c == 'L' || c == ',') c = ' ';
  }
  std::istringstream in(all);
  std::vector<std::array<double, 2>> points;
  for (std::array<double, 2> point{}; in >> point[0] >> point[1];) points.push_back(point);
  return points;
}

}  // namespace tribofit
