#!/usr/bin/env python3
"""Checks the manual: README.md, the texts of `identify help`, and the help of every verb.

- README.md has at most 12 kB, and every script and file it names exists.
- `identify help` has every subject that the texts refer to; no line of a text or of the help of a verb is wider than 80
  columns.
- Every option of every verb is described where it is listed, and every member of the JSON in the schema, once.
- The lines of Python in the manual (>>> ...) run with pandas on results as the manual makes them; left out where neither
  this interpreter nor that of the distribution has pandas.

usage: manual.py REPOSITORY IDENTIFY   exit status 1 and one line per offence
       manual.py --self-test           proves that each rule can fail
"""

import importlib.util
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

WIDTH = 80
LARGEST_README = 12 * 1024
TYPED = re.compile(r"^(-[\w-]+(\{false\})?,?)+( (TEXT|INT|UINT|FLOAT)\S*)?(=\S+)?( \.\.\.)?( in \[.*\])?( REQUIRED)?")
REFERENCE = re.compile(r"`?identify help ([a-z]+)`?")


def wide_lines(name, text):
    """Lines wider than a terminal must be."""
    for number, line in enumerate(text.splitlines(), 1):
        longest = max((len(word) for word in line.split()), default=0)
        if len(line) > WIDTH and longest < WIDTH / 2:  # a list of words without blanks cannot be broken
            yield f"{name}:{number}: {len(line)} columns: {line[:60]}"


def undescribed_options(name, text):
    """Options of a help without a sentence: nothing stands beside or below them."""
    lines = text.splitlines()
    for k, line in enumerate(lines):
        if not re.match(r"  -{1,2}[a-z]", line):
            continue
        beside = TYPED.sub("", line.strip()).strip()
        below = k + 1 < len(lines) and re.match(r"\s{20,}\S", lines[k + 1])
        if not beside and not below:
            yield f"{name}: {line.strip()} is not described"


def undescribed_members(schema, where="schema"):
    """Members of the JSON without a description of their own or of what they refer to."""
    if isinstance(schema, dict):
        for name, member in schema.get("properties", {}).items():
            if isinstance(member, dict) and "description" not in member and "$ref" not in member:
                yield f"{where}: '{name}' is not described"
        for key, value in schema.items():
            yield from undescribed_members(value, f"{where}/{key}")
    if isinstance(schema, list):
        for value in schema:
            yield from undescribed_members(value, where)


def missing_files(readme, repository):
    """Scripts and files that README.md names and that are not there."""
    for path in sorted(set(re.findall(r"[`(]((?:scripts|data|tests|include)/[\w./-]+)", readme))):
        if not (repository / path.rstrip("/.")).exists() and not path.startswith("data/figures"):
            yield f"README.md: {path} does not exist"


def python_lines(text):
    return [line.strip()[4:] for line in text.splitlines() if line.strip().startswith(">>> ")]


def example_offences(identify, repository, text):
    """What the lines of Python in a text fail with."""
    lines = python_lines(text)
    if not lines:
        return ["the manual has no lines of Python"]
    try:
        import pandas  # pylint: disable=unused-import,import-outside-toplevel
    except ImportError:
        print("manual: the lines of Python are left out (no pandas)")
        return []
    with tempfile.TemporaryDirectory() as directory:
        folder = pathlib.Path(directory)

        def run(*words):
            subprocess.run([identify, *words, "--quiet"], cwd=folder, check=True, capture_output=True)

        run("--radius", "15mm", "--json", "result.json", "--csv", "result-csv", str(repository / "data/example.csv"))
        (folder / "runs").mkdir()
        for repeat in "12":
            run("simulate", "--radius", "15mm", "--duration", "6s", "--rate", "2kHz", "--seed", repeat, "--out",
                f"runs/r15mm_{repeat}.csv")
        run("runs", "--pattern", "r{radius}mm_{repeat}.csv", "--speed", "4rpm", "--load", "50N")
        found, names, before = [], {}, os.getcwd()
        os.chdir(folder)
        try:
            for line in lines:
                try:
                    exec(line, names)  # pylint: disable=exec-used
                except Exception as error:  # pylint: disable=broad-except
                    found.append(f"manual: {line}: {error!r}")
        finally:
            os.chdir(before)
        return found


def offences(repository, identify):
    env = {**os.environ, "COLUMNS": str(WIDTH)}

    def said(*words):
        return subprocess.run([identify, *words], capture_output=True, text=True, check=True, env=env).stdout

    found = []
    readme = (repository / "README.md").read_text(encoding="utf-8")
    if len(readme.encode()) > LARGEST_README:
        found.append(f"README.md: {len(readme.encode())} bytes, more than {LARGEST_README}")
    found += missing_files(readme, repository)
    topics = re.findall(r"^  ([a-z]+) ", said("help"), re.MULTILINE)
    texts = {topic: said("help", topic) for topic in topics}
    for name, text in [("README.md", readme), *texts.items()]:
        found += [f"{name}: identify help {topic}: there is no such subject"
                  for topic in sorted(set(REFERENCE.findall(text)) - set(topics) - {"topic"})]
    for topic, text in texts.items():
        found += wide_lines(f"help {topic}", text)
    for verb in said("completion", "verbs").splitlines():
        text = said(*verb.split(), "--help")
        found += wide_lines(f"{verb} --help", text)
        found += undescribed_options(f"{verb} --help", text)
    schema = json.loads((repository / "data/schema/tribofit.schema.json").read_text(encoding="utf-8"))
    found += undescribed_members(schema)
    return found + example_offences(identify, repository, "\n".join(texts.values()))


def self_test():
    trials = [
        (list(wide_lines("a", "x " * 41)), 1),
        (list(wide_lines("a", "x" * 80)), 0),
        (list(undescribed_options("a", "  --radius TEXT\n  --speed TEXT   Of the disc\n")), 1),
        (list(undescribed_options("a", "  --radius TEXT\n                        Of friction\n")), 0),
        (list(undescribed_members({"properties": {"a": {"type": "number"}, "b": {"description": "B"}}})), 1),
        (list(missing_files("`scripts/none`", pathlib.Path("/"))), 1),
        (python_lines("  >>> 1 + 1\n  ... 2\n"), 1),
    ]
    wrong = [k for k, (found, count) in enumerate(trials) if len(found) != count]
    print(f"manual: {len(trials) - len(wrong)} of {len(trials)} made-up texts judged rightly {wrong or ''}")
    return 1 if wrong else 0


def go_on_with_pandas():
    """Where this interpreter lacks pandas, the one of the distribution has it from scripts/packages.txt."""
    system = "/usr/bin/python3"
    if importlib.util.find_spec("pandas") or not os.path.exists(system):
        return
    if os.path.realpath(sys.executable) != os.path.realpath(system):
        os.execv(system, [system, "-B", *sys.argv])


def main(arguments):
    if arguments == ["--self-test"]:
        return self_test()
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    found = offences(pathlib.Path(arguments[0]).resolve(), arguments[1])
    print("\n".join(found) if found else "manual: no offences")
    return 1 if found else 0


if __name__ == "__main__":
    go_on_with_pandas()
    sys.exit(main(sys.argv[1:]))
