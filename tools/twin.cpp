#include "tribofit/study/twin.hpp"
#include "memory.hpp"
#include "verbs.hpp"

using namespace tribofit;

namespace {

ExitStatus run_twin(const Settings& s, const std::vector<std::string>& arguments) {
  set_memory(Memory::given_back);
  const IdentifyOptions options = options_from(s);
  const Input input = only_input(s, options.read, "twin");
  TwinIdentification result;
  {
    ProgressLine line;
    TwinOptions more;
    more.seed = options.fit.seed;
    more.progress = [&line](std::string_view what, double part) { line.show(what, part); };
    result = identify_twin(input.trace, options, more);
  }
  const std::string& reason = result.twin.reason;
  return show_alone(s, input, result, arguments, reason.empty() ? "" : "there is no twin: " + reason);
}

}  // namespace

void add_twin(const Command& app) {
  const Command verb = app.add_verb(
      "twin", "The motion that law and rig predict beside the measured one",
      "Fits the law and the rig, simulates the same conditions for as long as the record, takes the simulated\n"
      "record through the same steps and compares the motions. With --effect there is a twin of the bare\n"
      "law and one of the law with the effects.\n\n"
      "Examples:\n"
      "  identify twin --radius 15mm --load 50N trace.csv\n"
      "  identify twin --radius 15mm --load 50N --effect frictional-lag trace.csv");
  const auto settings = std::make_shared<Settings>();
  add_input_options(verb, *settings);
  add_model_options(verb, *settings);
  add_output_options(verb, *settings);
  verb.on_run([settings, verb] { return run_twin(*settings, verb.own_options()); });
}
