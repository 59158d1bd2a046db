#!/usr/bin/env python3
"""Checks that no parameter, variable or capture is called `of`: it is named after what it is (machine, campaign, fit).

A function may be called so where an object stands before it: blocks.of(cycle).

usage: words.py REPOSITORY    exit status 1 and one line per offence
       words.py --self-test   proves that it can fail
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


def without_prose(text):
    """The same lines without comments and strings."""
    return PROSE.sub(lambda match: '""' + "\n" * match.group().count("\n"), text)


def offences(repository):
    found = []
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
]


if __name__ == "__main__":
    sys.exit(contract.run("words", __doc__, offences, TREES))
