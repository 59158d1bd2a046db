#include "output/described.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "output/csv_table.hpp"

namespace tribofit {
namespace {

enum class Colour { red, green };
std::string to_string(Colour colour) {
  return colour == Colour::red ? "red" : "green";
}

struct Ball {
  double size = 0, mass = 1;  // [m], [kg]
};
constexpr auto description(const Ball*) {
  return described("size_mm", in(1e-3, &Ball::size), "mass_kg", &Ball::mass);
}

struct Box {
  std::string name, owner;
  Colour colour = Colour::green;
  double lower = 0, upper = 0, tax = 0, seen = 5;
  std::vector<double> lengths;  // [m]
  std::vector<Ball> balls;
  std::optional<int> number;
  Ball best;
};
constexpr auto description(const Box*) {
  return described("name", &Box::name, "owner", or_null(&Box::owner), "colour", &Box::colour, "ci95",
                   ends(&Box::lower, &Box::upper), "tax", or_null(&Box::tax), "lengths_mm", in(1e-3, &Box::lengths, 3),
                   "balls", &Box::balls, "number", &Box::number, "more",
                   described("seen", &Box::seen, "mass", within(&Box::best, &Ball::mass)), "count",
                   [](const Box& box) { return box.balls.size(); });
}
void read_json(const Json& json, Colour& colour) {
  colour = json == "red" ? Colour::red : Colour::green;
}

Box a_box() {
  Box box;
  box.name = "b";
  box.colour = Colour::red;
  box.lower = 1;
  box.upper = std::nan("");
  box.lengths = {0.0012345, std::nan("")};
  box.balls = {{0.002, 3}};
  box.best.mass = 7;
  return box;
}

TEST(Described, IsWrittenUnderItsNamesInTheirOrder) {
  EXPECT_EQ(line_of(json_of(a_box())),
            R"({"name":"b","owner":null,"colour":"red","ci95":[1.0,null],"tax":null,"lengths_mm":[1.23,null],)"
            R"("balls":[{"size_mm":2.0,"mass_kg":3.0}],"number":null,"more":{"seen":5.0,"mass":7.0},"count":1})");
}

TEST(Described, ComesBackInSi) {
  Box full = a_box();
  full.owner = "me";
  full.tax = 0.5;
  full.number = 4;
  const Box back = read_from<Box>(json_of(full));
  EXPECT_EQ(line_of(json_of(back)), line_of(json_of(full)));
  EXPECT_NEAR(back.lengths[0], 0.00123, 1e-12);
  EXPECT_TRUE(std::isnan(back.upper) && std::isnan(back.lengths[1]));
  EXPECT_EQ(back.balls[0].size, 0.002);
  EXPECT_EQ(back.number, 4);
  EXPECT_EQ(back.best.mass, 7);
}

TEST(Described, WhatAFileDoesNotNameStaysAndNullIsNotKnown) {
  const Box box = read_from<Box>(Json::parse(R"({"owner": null, "more": {"seen": null}})"));
  EXPECT_EQ(box.owner, "");
  EXPECT_EQ(box.colour, Colour::green);
  EXPECT_TRUE(std::isnan(box.seen));
  EXPECT_EQ(box.best.mass, 1);
  EXPECT_THROW(read_from<Box>(Json::parse(R"({"balls": 3})")), Json::exception);
  EXPECT_THROW(read_from<Box>(Json::parse(R"([1])")), Json::exception);
}

TEST(Described, IsARowOfATable) {
  EXPECT_EQ(csv_names(json_of(Ball{})), "size_mm,mass_kg");
  EXPECT_EQ(csv_line(json_of(Ball{0.001, std::nan("")})), "1,\n");
}

}  // namespace
}  // namespace tribofit
