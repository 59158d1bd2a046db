#!/usr/bin/env python3
"""Checks that a file is one thing and a function reads as its own table of contents.

No source file has more than 400 lines, no function more than 60, counted from the line of its name to its closing brace.

usage: sizes.py REPOSITORY    exit status 1 and one line per offence
       sizes.py --self-test   proves on made-up files that each rule can fail
"""

import pathlib
import re
import sys

import contract

MOST_LINES_OF_A_FILE = 400
MOST_LINES_OF_A_FUNCTION = 60
DIRECTORIES = ("include", "src", "tools", "tests", "scripts")
SUFFIXES = {".hpp", ".cpp", ".js", ".mjs", ".css", ".py"}
BRACED = {".hpp", ".cpp", ".js", ".mjs"}

# clang-format leaves the closing brace under the first letter of what it closes, so indentation finds the end. A
# function's head has a parenthesis before its brace; what follows these words is a type, a scope or a statement.
NO_FUNCTION = re.compile(
    r"\s*(?:namespace|struct|class|enum|union|extern|if|for|while|switch|do|else|return|try|catch|public|private|case)\b|\s*[:,]")
HEAD = re.compile(r"^(\s*)[\w~:<>*&\[\]=,.\s\"'$-]*?([\w~]+|operator\S+)\s*\(|^(\s*)const (\w+) = (?:async )?\(")


def functions(lines):
    """(first line, number of lines, name) of each function, lambdas and methods among them."""
    for begin, line in enumerate(lines):
        head = HEAD.match(line)
        if not head or NO_FUNCTION.match(line) or line.lstrip().startswith(("//", "*", "#")):
            continue
        indent = head.group(1) or head.group(3) or ""
        opening = next((k for k in range(begin, min(begin + 12, len(lines)))
                        if lines[k].rstrip().endswith(("{", ";", "}"))), None)
        if opening is None or not lines[opening].rstrip().endswith("{"):
            continue
        if any(lines[k].strip() and not lines[k].startswith(indent + " ") and not lines[k].startswith(indent + ")")
               for k in range(begin + 1, opening + 1)):
            continue  # the brace is not this head's
        closing = re.compile(re.escape(indent) + r"\}")
        end = next((k for k in range(opening + 1, len(lines)) if closing.match(lines[k])), None)
        if end is not None:
            yield begin + 1, end - begin + 1, head.group(2) or head.group(4)


def python_functions(lines):
    for begin, line in enumerate(lines):
        head = re.match(r"(\s*)def (\w+)", line)
        if not head:
            continue
        inner = head.group(1) + " "
        end = begin
        for k in range(begin + 1, len(lines)):
            if lines[k].strip() and not lines[k].startswith(inner) and not lines[k].lstrip().startswith(")"):
                break
            end = k if lines[k].strip() else end
        yield begin + 1, end - begin + 1, head.group(2)


def offences(repository):
    found = []
    for path in contract.sources(repository, DIRECTORIES, SUFFIXES):
        lines = path.read_text(encoding="utf-8").splitlines()
        if len(lines) > MOST_LINES_OF_A_FILE:
            found.append(f"{path}: {len(lines)} lines, at most {MOST_LINES_OF_A_FILE}")
        parts = functions(lines) if path.suffix in BRACED else python_functions(lines) if path.suffix == ".py" else ()
        for number, count, name in parts:
            if count > MOST_LINES_OF_A_FUNCTION:
                found.append(f"{path}:{number}: {name} has {count} lines, at most {MOST_LINES_OF_A_FUNCTION}")
    return found


def body(count, indent="  "):
    return "".join(f"{indent}x += {k};\n" for k in range(count))


TREES = [  # files, number of offences
    ({"src/fit/a.cpp": "int f(int x) {\n" + body(58) + "}\n"}, 0),
    ({"src/fit/a.cpp": "int f(int x) {\n" + body(59) + "}\n"}, 1),
    ({"src/fit/a.cpp": "std::vector<int> f(int x,\n                   int y) {\n" + body(60) + "}\n"}, 1),
    ({"src/fit/a.cpp": "namespace a {\n\n" + body(100, "") + "}\n"}, 0),
    ({"src/fit/a.cpp": "struct A {\n  void f() {\n" + body(60, "    ") + "  }\n};\n"}, 1),
    ({"src/fit/a.cpp": "class A {\n" + body(100) + "};\n"}, 0),
    ({"src/fit/a.cpp": "int f(int);\nclass A {\n" + body(100) + "};\n"}, 0),
    ({"src/fit/a.cpp": "TEST(Suite, Case) {\n" + body(60) + "}\n"}, 1),
    ({"src/report/a.js": "function f(x) {\n" + body(60) + "}\n"}, 1),
    ({"src/report/a.js": "const f = (x) => {\n" + body(60) + "};\n"}, 1),
    ({"tests/a.py": "def f(x):\n" + "    x += 1\n" * 60}, 1),
    ({"tests/a.py": "def f(x):\n" + "    x += 1\n" * 59 + "\n\ny = 1\n"}, 0),
    ({"tools/a.cpp": "\n" * 400}, 0),
    ({"tools/a.cpp": "\n" * 401}, 1),
]


if __name__ == "__main__":
    sys.exit(contract.run("sizes", __doc__, offences, TREES))
