#!/usr/bin/env python3
"""Follows README.md and the texts of `identify help` as a newcomer does: every command in order, each must print what
stands below it ("[...]" stands for lines that are left out) and end well, or as "(exit status 1)" below it says.

usage: newcomer.py [--help-texts] [IDENTIFY]
       Without IDENTIFY the repository is cloned anew and built by scripts/run, as README.md says. --help-texts: the
       texts in tools/help as well. Exit status 1 and the differences where there are any.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
LEFT_OUT = "[...]"
STATUS = re.compile(r"^\(exit status (\d+)\)$")
SERVES = "identify explore"
# What the README takes for granted: files of the reader's own.
GIVEN = """
mkdir -p runs
for r in 9 12 15; do for n in 1 2; do
  identify simulate --radius ${r}mm --speed 4rpm --load 50N --duration 8s --rate 2kHz --noise-mu 0.003 \
    --noise-v 0.02mm/s --scatter 0.004 --seed $r$n --quiet --out runs/r${r}mm_4rpm_50N_$n.csv
done; done
"""


def fenced(text):
    """Lines of the blocks that a shell understands."""
    for kind, block in re.findall(r"^```(\w*)\n(.*?)^```", text, re.MULTILINE | re.DOTALL):
        if kind in ("", "sh", "bash"):
            yield block


def indented(text):
    """Examples of a help text: stretches indented by two that begin with '$ '."""
    lines = text.splitlines()
    for k, line in enumerate(lines):
        if not line.startswith("  $ ") or (k > 0 and lines[k - 1].startswith("  ") and lines[k - 1].strip()):
            continue
        end = k
        while end < len(lines) and (lines[end].startswith("  ") or not lines[end].strip()):
            end += 1
        yield "\n".join(one[2:] for one in lines[k:end]) + "\n"


def commands(block):
    """(command, what is printed below it); without a prompt every line is a command, and nothing is promised."""
    prompted = re.search(r"^\$ ", block, re.MULTILINE)
    command, printed = None, []
    lines = block.splitlines()
    k = 0
    while k < len(lines):
        line = lines[k]
        if line.startswith("$ ") or (not prompted and line.strip()):
            if command:
                yield command, printed
            command, printed = line[2:] if prompted else line, []
            while command.endswith("\\"):
                k += 1
                command = command[:-1] + lines[k].strip()
        elif command:
            printed.append(line)
        k += 1
    if command:
        yield command, printed


def differences(promised, said):
    """The first promised line that is not where it should be; None where all are."""
    at, gap = 0, False
    while promised and not promised[-1].strip():
        promised = promised[:-1]
    for line in promised:
        if line.strip() == LEFT_OUT:
            gap = True
            continue
        wanted = line.rstrip()
        if gap and not wanted:
            continue
        found = next((k for k in range(at, len(said)) if said[k].rstrip() == wanted), None) if gap else (
            at if at < len(said) and said[at].rstrip() == wanted else None)
        if found is None:
            return wanted
        at, gap = found + 1, False
    return None


def run(command, folder, environment):
    """Exit status and lines of a command; one that serves is ended when it says where."""
    if command.startswith(SERVES):
        with subprocess.Popen(["bash", "-c", "exec " + command], cwd=folder, env=environment, stdout=subprocess.PIPE,
                              text=True) as server:
            first = server.stdout.readline()
            server.terminate()
            return 0 if "http://127.0.0.1" in first + server.stdout.read() else 1, []
    done = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        print(done.stderr, file=sys.stderr)
    return done.returncode, done.stdout.splitlines()


def follow(name, blocks, folder, environment):
    wrong = count = 0
    for block in blocks:
        for command, promised in commands(block):
            if command.startswith(("scripts/", "export ", "cmake ")):
                continue  # building is done; tests and benchmarks take their own time
            count += 1
            expected = next((int(STATUS.match(one)[1]) for one in promised if STATUS.match(one)), 0)
            status, said = run(command, folder, environment)
            line = differences([one for one in promised if not STATUS.match(one)], said)
            if status != expected or line is not None:
                wrong += 1
                print(f"{name}: {command}")
                print(f"  ends with {status}" if status != expected else f"  does not print: {line}")
                if line is not None:
                    (folder / f"printed-{wrong}.txt").write_text("\n".join(said), encoding="utf-8")
    print(f"{name}: {count} commands, {wrong} differ")
    return wrong


def main(arguments):
    texts = "--help-texts" in arguments
    named = [argument for argument in arguments if argument != "--help-texts"]
    if len(named) > 1 or any(one.startswith("--") for one in named):
        print(__doc__, file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as directory:
        folder = pathlib.Path(directory) / "clone"
        if named:
            folder.mkdir()
            shutil.copytree(REPOSITORY / "data", folder / "data")
            tools = pathlib.Path(named[0]).resolve().parent
        else:
            subprocess.run(["git", "clone", "-q", str(REPOSITORY), str(folder)], check=True)
            subprocess.run([folder / "scripts/run"], check=True)
            tools = folder / "build/release/tools"
        environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "LC_ALL": "C.UTF-8", "COLUMNS": "80"}
        subprocess.run(["bash", "-ec", GIVEN], cwd=folder, env=environment, check=True)
        wrong = follow("README.md", fenced((REPOSITORY / "README.md").read_text(encoding="utf-8")), folder, environment)
        for path in sorted((REPOSITORY / "tools/help").glob("*.txt")) if texts else []:
            wrong += follow(path.name, indented(path.read_text(encoding="utf-8")), folder, environment)
        return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
