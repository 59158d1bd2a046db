#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/ingest/trace.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {

enum class Channel {
  time,
  mu,
  v_b,
  v_r,
  force,
  torque,
  load,
  speed,
  angle,
  temperature,
  std_error,
  spring,
  x_b,
  x_d,
  v_lp,
  step
};

/// What a column without a unit means.
enum class Unitless {
  si,        ///< it is in SI, which is noted
  number,    ///< it needs none
  friction,  ///< it is as friction is
  unknown    ///< the unit must be stated
};

/// A channel of a trace: all that there is to say of it.
struct ChannelInfo {
  std::string_view key;                        ///< as the command line and manifests name it
  std::initializer_list<Quantity> quantities;  ///< that it may be given in, the usual one first
  std::string_view unit, si_unit;              ///< that people use; that of SI
  Unitless unitless;
  std::vector<double> Trace::*target;  ///< where it goes; of several channels with one target a record has one
  std::string_view names;  ///< that the field uses, divided by blanks: lower case, no separators, the usual one first
  std::string_view plain = {};  ///< names that fit, and do not say of what the column is
};

/// The channels, in the order of Channel.
// clang-format off
inline constexpr std::array<ChannelInfo, 16> channel_infos = {{
    {"time", {Quantity::time}, "s", "s", Unitless::si, &Trace::time,
     "time t timestamp elapsedtime testtime steptime xvalue zeit temps \u65f6\u95f4"},
    {"mu", {Quantity::dimensionless}, "1", "1", Unitless::number, &Trace::friction,
     "mu \u03bc \u00b5 cof frictioncoefficient coefficientoffriction coeffriction coeffoffriction friction "
     "frictioncoeff tractioncoeff tractioncoefficient reibwert reibungszahl reibungskoeffizient "
     "\u6469\u64e6\u7cfb\u6570 \u6469\u64e6\u56e0\u6570"},
    {"v_b", {Quantity::velocity, Quantity::angular_velocity}, "mm/s", "m/s", Unitless::unknown, &Trace::velocity,
     "vb blockvelocity blockspeed vibrometer velocity vibrometervelocity v geschwindigkeit \u901f\u5ea6"},
    {"v_r", {Quantity::velocity, Quantity::angular_velocity}, "mm/s", "m/s", Unitless::unknown, &Trace::velocity,
     "vr slidingvelocity relativevelocity slidingspeed rubbingvelocity rubbingspeed rubbing vrel slipvelocity "
     "vslip gleitgeschwindigkeit \u76f8\u5bf9\u901f\u5ea6 \u6ed1\u52a8\u901f\u5ea6"},
    {"force", {Quantity::force, Quantity::pressure}, "N", "N", Unitless::si, &Trace::friction,
     "ft frictionforce tangentialforce fx ff ffriction force lateralforce tractionforce kraft reibkraft "
     "shearforce shearload shearstress shrstress shstress tau schubspannung \u6469\u64e6\u529b"},
    {"torque", {Quantity::torque}, "Nm", "N m", Unitless::si, &Trace::friction,
     "torque frictiontorque m moment drehmoment reibmoment \u626d\u77e9 \u8f6c\u77e9"},
    {"load", {Quantity::force, Quantity::pressure}, "N", "N", Unitless::si, &Trace::load,
     "fn normalforce load normalload fz weight wob weightonbit ballload normalkraft normalstress "
     "effectivenormalstress effnormalstress norstress sigman normalspannung \u8f7d\u8377 \u6b63\u538b\u529b "
     "\u6cd5\u5411\u529b"},
    {"speed", {Quantity::angular_velocity}, "rpm", "rad/s", Unitless::unknown, &Trace::disc_speed,
     "discspeed diskspeed rpm speed rotationalspeed rotaryvelocity spindlespeed omega discvelocity "
     "angularvelocity rotaryspeed drehzahl \u8f6c\u901f"},
    {"angle", {Quantity::angle}, "deg", "rad", Unitless::unknown, &Trace::disc_angle,
     "angle discangle diskangle rotaryposition theta phi position winkel \u89d2\u5ea6"},
    {"temperature", {Quantity::temperature}, "degC", "degC", Unitless::si, &Trace::temperature,
     "temperature temp temperatur \u6e29\u5ea6"},
    {"std_error", {Quantity::dimensionless, Quantity::force, Quantity::torque}, "1", "1", Unitless::friction,
     &Trace::friction_std_error,
     "stderror standarderror stderr muerror mustderror frictionstderror uncertainty sem se"},
    {"spring", {Quantity::force, Quantity::dimensionless}, "N", "N", Unitless::si, &Trace::friction,
     "spring springforce springpull pull fspring federkraft"},
    {"x_b", {Quantity::length}, "mm", "m", Unitless::unknown, &Trace::block_position,
     "xb blockdisplacement blockposition sliderdisplacement sliderposition massdisplacement"},
    {"x_d", {Quantity::length}, "mm", "m", Unitless::unknown, &Trace::drive_position,
     "xd drivedisplacement driveposition basedisplacement baseposition stagedisplacement stageposition "
     "carriagedisplacement carriageposition lpdisp lpdisplacement loadpointdisplacement loadpointdisp lpdispl "
     "loadpointposition loadpoint xlp ramdisplacement pistondisplacement",
     "displacement disp displ sheardisplacement sheardisp sheardispl axialdisplacement totaldisplacement vdcdt "
     "verschiebung scherweg position x"},
    {"v_lp", {Quantity::velocity}, "um/s", "m/s", Unitless::unknown, &Trace::load_point_speed,
     "vlp loadpointvelocity loadpointspeed loadpointrate lpvelocity lpspeed drivevelocity drivingvelocity "
     "ramvelocity",
     "speed velocity v slidingvelocity slidingspeed shearvelocity slipvelocity sliprate rate"},
    {"step", {}, "", "", Unitless::number, nullptr,
     "step recipestep stepnumber segment"}}};
// clang-format on
inline constexpr std::size_t channel_count = channel_infos.size();

/// All of them, in their order.
inline constexpr auto all_channels = [] {
  std::array<Channel, channel_count> all{};
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<Channel>(k);
  return all;
}();

constexpr std::size_t index_of(Channel channel) {
  return static_cast<std::size_t>(channel);
}
constexpr const ChannelInfo& info_of(Channel channel) {
  return channel_infos[index_of(channel)];
}

/// "time", "mu", "v_b", ...
constexpr std::string_view to_string(Channel channel) {
  return info_of(channel).key;
}
std::vector<std::string> channel_names();

}  // namespace tribofit
