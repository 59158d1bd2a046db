#!/usr/bin/env python3
"""Checks that the pages of data/validation are fresh: a page is stale where a source of one of its blocks has changed more
than 30 days after the block was measured, or where no block is left in it.

usage: validation.py REPOSITORY    exit status 1 and one line per offence
       validation.py --self-test   proves that each rule can fail
"""

import datetime
import importlib.machinery
import pathlib
import subprocess
import sys
import tempfile
import types

LONGEST_DAYS = 30
SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/validation"
pages = types.ModuleType("pages")
importlib.machinery.SourceFileLoader("pages", str(SCRIPT)).exec_module(pages)


def last_change(repository, sources):
    """The date of the last commit that changed a source; None where there is no history."""
    run = subprocess.run(["git", "-C", repository, "log", "-1", "--format=%cs", "--", *sources], capture_output=True,
                         text=True, check=False)
    return datetime.date.fromisoformat(run.stdout.strip()) if run.returncode == 0 and run.stdout.strip() else None


def offences(repository, changed=last_change):
    for path in sorted((repository / "data/validation").glob("*.md")):
        page = path.read_text(encoding="utf-8")
        blocks = list(pages.BLOCK.finditer(page))
        if not blocks:
            yield f"{path.name}: nothing in it was written by a script"
        if page.count("<!-- end -->") != len(blocks):
            yield f"{path.name}: a block has no end, or an end no block"
        for one in blocks:
            script, sources = one["command"].split()[0], one["sources"].split()
            for needed in [script, *sources]:
                if not (repository / needed).exists():
                    yield f"{path.name}: {needed} does not exist"
            if not one["text"].strip():
                yield f"{path.name}: the block of {script} is empty"
            change = changed(repository, sources)
            measured = datetime.date.fromisoformat(one["date"])
            if change and (change - measured).days > LONGEST_DAYS:
                yield f"{path.name}: {one['command']} was measured on {measured}, and its sources changed on {change}"


def self_test():
    good = pages.block("scripts/made", "2026-01-01", ["src"], "| a |\n")
    bad = {"nothing in it": "# Only words\n", "no end": good + "<!-- end -->\n", "does not exist": good.replace("src", "gone"),
           "is empty": good.replace("| a |", ""), "was measured on": good.replace("2026-01-01", "2025-01-01")}
    with tempfile.TemporaryDirectory() as folder:
        repository = pathlib.Path(folder)
        for directory in ("src", "scripts", "data/validation"):
            (repository / directory).mkdir(parents=True)
        (repository / "scripts/made").touch()
        page = repository / "data/validation/page.md"

        def found(text):
            page.write_text(text, encoding="utf-8")
            return list(offences(repository, lambda *_: datetime.date(2026, 1, 20)))

        assert not found("# Page\n\n" + good), found(good)
        for reason, text in bad.items():
            assert any(reason in offence for offence in found(text)), (reason, found(text))
        new = pages.block("scripts/made", "2026-01-19", ["src"], "| b |")
        assert pages.with_block("# Page\n\n" + good + "after\n", "scripts/made", new) == "# Page\n\n" + new + "after\n"
        assert pages.with_block("# Page\n", "scripts/made", new) == "# Page\n\n" + new
    return 0


if sys.argv[1:] == ["--self-test"]:
    sys.exit(self_test())
found = list(offences(pathlib.Path(sys.argv[1])))
print("".join(f"validation: {offence}\n" for offence in found), end="")
sys.exit(1 if found else 0)
