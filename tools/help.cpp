
#include "help_texts.hpp"
#include "verbs.hpp"

void add_help(const Command& app) {
  const Command verb =
      app.add_verb("help", "Explain a subject at length, or list the subjects", "Example:\n  identify help statistics");
  const auto topic = std::make_shared<std::string>();
  std::vector<std::string> names;
  for (const HelpText& text : help_texts()) names.emplace_back(text.topic);
  verb.add_option("TOPIC", *topic, "Subject").one_of(names);
  verb.on_run([topic] {
    std::string out = topic->empty() ? "Subjects of 'identify help TOPIC':\n" : "";
    for (const HelpText& text : help_texts()) {
      const std::string whole(text.text);
      if (topic->empty()) {
        out += "  " + std::string(text.topic) + std::string(14 - text.topic.size(), ' ') +
               whole.substr(0, whole.find('\n')) + "\n";
      } else if (*topic == text.topic) {
        out += whole;
      }
    }
    print(out);
  });
}
