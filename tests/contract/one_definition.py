#!/usr/bin/env python3
"""Checks that no two headers define a type of the same name in namespace tribofit.

The compiler cannot see it when they meet in no source file, and the linker keeps one destructor for both.

usage: one_definition.py REPOSITORY    exit status 1 and one line per offence
       one_definition.py --self-test   proves that it can fail
"""

import collections
import pathlib
import re
import sys

import contract

# Types at namespace level stand at the beginning of a line, as clang-format leaves them.
DEFINITION = re.compile(r"^(?:struct|class|enum class|enum)\s+(\w+)[^;]*$")


def offences(repository):
    places = collections.defaultdict(list)
    for base in ("include", "src", "tools"):
        for path in sorted((repository / base).rglob("*.hpp")):
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                match = DEFINITION.match(line)
                if match and not line.rstrip().endswith(";"):
                    places[match.group(1)].append(f"{path}:{number}")
    return [f"{name} is defined at {' and at '.join(where)}" for name, where in places.items() if len(where) > 1]


def with_headers(first, second):
    return {"src/ingest/a.hpp": first, "src/oscillator/a.hpp": second}


TREES = [  # files, number of offences
    (with_headers("struct Recording {\n};\n", "struct Recording {\n};\n"), 1),
    (with_headers("class Fit : public Base {\n};\n", "enum class Fit {\n};\n"), 1),
    (with_headers("struct Recording {\n};\n", "struct Recording;\n"), 0),
    (with_headers("struct Outer {\n  struct Part {\n  };\n};\n", "struct Part {\n};\n"), 0),
]


if __name__ == "__main__":
    sys.exit(contract.run("one definition", __doc__, offences, TREES))
