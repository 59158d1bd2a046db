#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "plateau_search.hpp"
#include "recording_faults.hpp"
#include "tribofit/ingest/trace.hpp"

namespace tribofit::kinematics {

/// The samples of a trace that are not used, and why.
class SpoiltSamples {
 public:
  /// Looks for markers, spikes and frozen stretches in every channel and bridges them. channels: of the trace, which
  /// are outlined anew where they were bridged.
  SpoiltSamples(Trace& trace, ChannelOutlines& channels, int threads);

  /// Samples at a limit of the range of a channel (SampleFault::friction or velocity); they keep their values.
  void add_clipped(const std::vector<SampleSpan>& spans, std::uint8_t kind) { mark(spans, kind); }

  /// Samples whose velocity is hardly known; they keep their values.
  void add_unsure(const std::vector<SampleSpan>& spans) { mark(spans, SampleFault::velocity); }

  /// A machine that stands still before, after or while it stick-slips. `plateau`: where v_b rests in stick [m/s].
  void add_standstill(const PlateauSearch& search, double plateau, const Trace& trace);

  /// A stretch in which the motion is not known for another reason.
  void add_unknown(const SampleSpan& span) { mark({span}, SampleFault::any); }

  /// Samples over which a correction smears the velocity.
  void add_smeared(const SampleSpan& span) { mark({span}, SampleFault::velocity); }

  bool any() const { return !faults_.empty(); }
  /// Longest stretch in which neither channel changed.
  const SampleSpan& longest_still() const { return still_; }
  std::size_t spikes() const { return spikes_; }
  double frozen_part() const;                                               ///< of the record
  const std::vector<std::string>& sentences() const { return sentences_; }  ///< what was found and left out
  std::vector<std::uint8_t> take() { return std::move(faults_); }  ///< as Motion::faults, of the trace's samples

 private:
  void clean(std::vector<double>& channel, ChannelOutline& outline, const ChannelFaults& faults,
             const std::string& name, std::uint8_t kind);
  void mark(const std::vector<SampleSpan>& spans, std::uint8_t kind);

  std::size_t size_, spikes_ = 0, frozen_ = 0;
  SampleSpan still_;
  std::vector<std::uint8_t> faults_;
  std::vector<std::string> sentences_;
};

}  // namespace tribofit::kinematics
