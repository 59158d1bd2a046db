#!/usr/bin/env python3
"""Checks that an effect is known by name in its own header only.

The keys are read from include/tribofit/friction/effects/*.hpp. In src/ and tools/ none of them may stand in quotes: what
must be known of an effect is said by its EffectInfo and its hooks, and a name that merely coincides (a column, a check
of the data) is a constant in a header of its own.

usage: effect_keys.py REPOSITORY    exit status 1 and one line per offence
       effect_keys.py --self-test   proves that it can fail
"""

import pathlib
import re
import sys
import tempfile

EFFECTS = pathlib.Path("include", "tribofit", "friction", "effects")
KEY = re.compile(r'\bstatic constexpr std::string_view key\s*=\s*"([^"]+)"')
COMMENT = re.compile(r"^\s*(//|\*).*$|\s//[/!]?<?\s.*$")
SOURCE_SUFFIXES = {".hpp", ".cpp", ".h", ".inc"}


def keys_of(repository):
    keys = set()
    for path in sorted((repository / EFFECTS).glob("*.hpp")):
        keys.update(KEY.findall(path.read_text(encoding="utf-8")))
    return keys


def offences(repository):
    keys = keys_of(repository)
    if not keys:
        return [f"{repository / EFFECTS}: no key of an effect was found"]
    # In quotes alone, or with a form or a parameter: "rate-state", "rate-state:healing", "runout.A".
    quoted = re.compile(r'"(' + "|".join(sorted(map(re.escape, keys))) + r')([:.][^"]*)?"')
    found = []
    for base in ("src", "tools"):
        for path in sorted((repository / base).rglob("*")):
            if path.suffix not in SOURCE_SUFFIXES:
                continue
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                for match in quoted.finditer(COMMENT.sub("", line)):
                    found.append(f"{path}:{number}: the effect {match.group(1)} is known by name")
    return found


def self_test():
    header = 'struct Lag {\n  static constexpr std::string_view key = "lag";\n};\n'
    cases = [  # file, its text, whether it must be refused
        ("src/fit/a.cpp", 'if (info.key == "lag") return;\n', True),
        ("tools/a.cpp", 'make_effect("lag:other");\n', True),
        ("src/study/a.cpp", 'value("lag.tau");\n', True),
        ("src/fit/a.cpp", "if (info.key == Lag::key) return;\n", False),
        ("src/fit/a.cpp", '// as in "lag"\nint x;  ///< "lag"\n', False),
        ("src/fit/a.cpp", 'say("lags behind");\n', False),
        ("tests/fit/a.cpp", 'make_effect("lag");\n', False),
    ]
    wrong = 0
    for name, text, refused in cases:
        with tempfile.TemporaryDirectory() as directory:
            root = pathlib.Path(directory)
            for file, content in ((EFFECTS / "lag.hpp", header), (name, text)):
                (root / file).parent.mkdir(parents=True, exist_ok=True)
                (root / file).write_text(content, encoding="utf-8")
            if bool(offences(root)) != refused:
                print(f"{name} with {text!r} should {'' if refused else 'not '}have been refused")
                wrong += 1
    with tempfile.TemporaryDirectory() as directory:
        wrong += not offences(pathlib.Path(directory))
    print(f"effect keys: {len(cases) + 1 - wrong} of {len(cases) + 1} made-up trees judged rightly")
    return wrong == 0


def main(arguments):
    if arguments == ["--self-test"]:
        return 0 if self_test() else 1
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    found = offences(pathlib.Path(arguments[0]))
    print("\n".join(found) if found else "effect keys: no offences")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
