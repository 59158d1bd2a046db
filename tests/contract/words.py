#!/usr/bin/env python3
"""Checks names and the words that people read.

- No parameter, variable or capture is called `of`: it is named after what it is (machine, campaign, fit). A function
  may be called so where an object stands before it: blocks.of(cycle).
- What people read (tools/help, README.md, string literals of the sources) has no word that the glossary replaces:
  AVOIDED gives the word to write instead, ALLOWED the contexts in which the word is right.

usage: words.py REPOSITORY    exit status 1 and one line per offence
       words.py --self-test   proves that each rule can fail
"""

import pathlib
import re
import sys

import contract

DIRECTORIES = ("include", "src", "tools", "tests")
SUFFIXES = {".hpp", ".cpp", ".h", ".inc", ".js", ".mjs"}
PROSE = re.compile(r"""//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])'|`(?:\\.|[^`\\])*`""", re.DOTALL)
NAME = re.compile(r"[\w>&*,(\[]\s*\bof\b\s*(?=[,);={:.\]]|->|=>)")
LOOP = re.compile(r"\b(?:const|let) [\w\[\]{}, ]+$")  # for (const x of [...]) in JavaScript

TEXT_DIRECTORIES = ("include", "src", "tools")
# Whole words, with any white space between them, as they stand in a sentence: the words to write instead.
AVOIDED = {
    "data not seen": "held-out data",
    "held-out RMSE": "held-out error",
    "the floor": "the noise floor",
    "is missing": "is found (an effect)",
    "are missing": "are found (effects)",
    "missing effect": "effect that explains it",
    "lacks an effect": "an effect is not modelled",
    "unsupported": "not supported by the data",
    "published protocol": "per-cycle extremes",
    "can be had": "is identified",
    "cannot be had": "could not be identified",
    "told": "reported, or distinguishable",
    "telling": "discriminating",
    "bend": "curvature",
    "bends": "curvatures",
    "fullness": "spin factor",
    "complain": "report",
    "no chance": "significant",
    "is none": "is empty",
    "no number": "not a number",
    "stand behind": "put after",
    "stands behind": "put after",
    "house": "library",
    "rooms": "modules",
    "doors": "boundaries",
}
# Where the word is right. Quotes are those of a whole literal.
ALLOWED = (
    '"unsupported"',  # the word of the JSON
    "bend like bristles",  # what contacts do
    "samples are missing",  # of a recording
    "token is missing",  # of a request
    "do what is missing",  # runs of a campaign
    "installs what is missing",  # packages
)


def without_prose(text):
    """The same lines without comments and strings."""
    return PROSE.sub(lambda match: '""' + "\n" * match.group().count("\n"), text)


def literals(code):
    """(offset, text) of each string literal with its quotes; neighbours that the compiler joins are one."""
    parts = []
    end = None
    for match in PROSE.finditer(code):
        token = match.group()
        if token.startswith(("//", "/*", "'")):
            continue
        if parts and token.startswith('"') and code[end:match.start()].strip() == "":
            parts[-1][1] = parts[-1][1][:-1] + token[1:]
        else:
            parts.append([match.start(), token])
        end = match.end()
    return parts


def whole_words(phrase):
    return re.compile(r"(?<![\w-])" + r"\s+".join(map(re.escape, phrase.split())) + r"(?![\w-])", re.IGNORECASE)


AVOIDED_PATTERNS = [(phrase, instead, whole_words(phrase)) for phrase, instead in AVOIDED.items()]
ALLOWED_PATTERN = re.compile("|".join(r"\s+".join(map(re.escape, context.split())) for context in ALLOWED), re.IGNORECASE)


def avoided_words(text):
    """(offset, phrase, what to write instead) of each word of a text that the glossary replaces."""
    allowed = [match.span() for match in ALLOWED_PATTERN.finditer(text)]
    for phrase, instead, pattern in AVOIDED_PATTERNS:
        for match in pattern.finditer(text):
            if not any(begin <= match.start() and match.end() <= end for begin, end in allowed):
                yield match.start(), phrase, instead


def texts(repository):
    """(path, line, text) of all that people read."""
    for path in [repository / "README.md", *sorted((repository / "tools/help").glob("*.txt"))]:
        if path.exists():
            yield path, 1, path.read_text(encoding="utf-8")
    for path in contract.sources(repository, TEXT_DIRECTORIES, SUFFIXES):
        code = path.read_text(encoding="utf-8")
        for offset, literal in literals(code):
            yield path, code.count("\n", 0, offset) + 1, literal


def glossary_offences(repository):
    for path, first, text in texts(repository):
        for at, phrase, instead in avoided_words(text):
            yield f"{path}:{first + text.count(chr(10), 0, at)}: '{phrase}': {instead}"


def offences(repository):
    found = list(glossary_offences(repository))
    for path in contract.sources(repository, DIRECTORIES, SUFFIXES):
        text = without_prose(path.read_text(encoding="utf-8"))
        for match in NAME.finditer(text):
            if path.suffix in {".js", ".mjs"} and LOOP.search(text[:match.start() + 1]):
                continue
            found.append(f"{path}:{text.count(chr(10), 0, match.end()) + 1}: `of` is the name of a thing")
    return found


TREES = [  # files, number of offences
    ({"src/fit/a.hpp": "int count(const Machine& of, int size);\n"}, 1),
    ({"src/fit/a.cpp": "int f(const Machine&\n          of) {\n  return 1;\n}\n"}, 1),
    ({"tests/a.cpp": "const auto part = [&](Machine* of) { return of->mass + 1; };\n"}, 2),
    ({"tools/a.cpp": "Machine of;\nof.mass = 1;\n"}, 1),
    ({"src/a.js": "const draw = (of) => 1;\n"}, 1),
    ({"src/a.js": "for (const x of [1, 2]) draw(x);\nfor (const y of list) draw(y);\n"}, 0),
    ({"src/fit/a.hpp": "/* a list, of numbers */\nchar c = '\"';\nint x;  ///< one (of) them\nconst char* s = \"one of, two\";\n"}, 0),
    ({"src/fit/a.hpp": "struct Blocks {\n  int of(int cycle) const;\n};\nint x = blocks.of(3);\n"}, 0),
    ({"src/a.cpp": 'say("to see which effect is missing");\n'}, 1),
    ({"src/a.cpp": 'say("to see which effect is "\n    "missing");\n'}, 1),
    ({"src/a.cpp": 'say("to see which effect is", "missing");\n'}, 0),
    ({"src/a.cpp": "// It is missing.\nint missing = 0;  /* told apart */\n"}, 0),
    ({"tools/a.cpp": 'say(R"(at the floor)");\n'}, 1),
    ({"include/a.hpp": 'const char* word = "unsupported";\n'}, 0),
    ({"include/a.hpp": 'const char* word = "an unsupported effect";\n'}, 1),
    ({"src/page/a.js": "const note = `These cannot be told from one another.`;\n"}, 1),
    ({"tests/a.cpp": 'EXPECT_EQ(text, "an effect is missing");\n'}, 0),
    ({"README.md": "It installs what\nis missing. The floor is known.\n"}, 1),
    ({"tools/help/a.txt": "Two effects cannot be\ntold apart, and options stand\n  behind the command.\n"}, 2),
    ({"tools/help/a.txt": "At the noise floor; flooring, untold, is-missing.\n"}, 0),
]


if __name__ == "__main__":
    sys.exit(contract.run("words", __doc__, offences, TREES))
