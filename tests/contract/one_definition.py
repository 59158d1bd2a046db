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
import tempfile

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


def self_test():
    cases = [
        ("struct Recording {\n};\n", "struct Recording {\n};\n", True),
        ("class Fit : public Base {\n};\n", "enum class Fit {\n};\n", True),
        ("struct Recording {\n};\n", "struct Recording;\n", False),
        ("struct Outer {\n  struct Part {\n  };\n};\n", "struct Part {\n};\n", False),
    ]
    wrong = 0
    for first, second, refused in cases:
        with tempfile.TemporaryDirectory() as directory:
            root = pathlib.Path(directory)
            for room, text in (("ingest", first), ("oscillator", second)):
                (root / "src" / room).mkdir(parents=True)
                (root / "src" / room / "a.hpp").write_text(text, encoding="utf-8")
            if bool(offences(root)) != refused:
                print(f"{first!r} and {second!r} should {'' if refused else 'not '}have been refused")
                wrong += 1
    print(f"one definition: {len(cases) - wrong} of {len(cases)} made-up pairs judged rightly")
    return wrong == 0


def main(arguments):
    if arguments == ["--self-test"]:
        return 0 if self_test() else 1
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    found = offences(pathlib.Path(arguments[0]))
    print("\n".join(found) if found else "one definition: no offences")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
