"""What the contracts share: the command line, and a proof on made-up trees that a contract can fail."""

import pathlib
import sys
import tempfile


def count_in(offences, files):
    """The offences in a tree of {path: text}."""
    with tempfile.TemporaryDirectory() as directory:
        root = pathlib.Path(directory)
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        return len(offences(root))


def sources(repository, directories, suffixes):
    """The files of ours below these directories, in order."""
    for directory in directories:
        for path in sorted((repository / directory).rglob("*")):
            if path.suffix in suffixes and "node_modules" not in path.parts:
                yield path


def self_test(name, offences, trees):
    wrong = 0
    for files, expected in trees:
        count = count_in(offences, files)
        if count != expected:
            print(f"{files}: {count} offences instead of {expected}")
            wrong += 1
    print(f"{name}: {len(trees) - wrong} of {len(trees)} made-up trees judged rightly")
    return wrong == 0


def run(name, usage, offences, trees):
    """Exit status of a contract.

    `offences(repository)` gives one line per offence, `trees` the made-up trees {path: text} with how many there are.
    """
    if sys.argv[1:] == ["--self-test"]:
        return 0 if self_test(name, offences, trees) else 1
    if len(sys.argv) != 2:
        print(usage, file=sys.stderr)
        return 2
    found = offences(pathlib.Path(sys.argv[1]))
    print("\n".join(found) if found else f"{name}: no offences")
    return 1 if found else 0
