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

import contract

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


def with_effect(name, text):
    """A tree of one effect called lag and one more file."""
    return {EFFECTS / "lag.hpp": 'struct Lag {\n  static constexpr std::string_view key = "lag";\n};\n', name: text}


TREES = [  # files, number of offences
    (with_effect("src/fit/a.cpp", 'if (info.key == "lag") return;\n'), 1),
    (with_effect("tools/a.cpp", 'make_effect("lag:other");\n'), 1),
    (with_effect("src/study/a.cpp", 'value("lag.tau");\n'), 1),
    (with_effect("src/fit/a.cpp", "if (info.key == Lag::key) return;\n"), 0),
    (with_effect("src/fit/a.cpp", '// as in "lag"\nint x;  ///< "lag"\n'), 0),
    (with_effect("src/fit/a.cpp", 'say("lags behind");\n'), 0),
    (with_effect("tests/fit/a.cpp", 'make_effect("lag");\n'), 0),
    ({}, 1),  # no effect at all
]


if __name__ == "__main__":
    sys.exit(contract.run("effect keys", __doc__, offences, TREES))
