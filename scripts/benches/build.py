"""What it costs to build tribofit, measured in a fresh clone without ccache: processor time of a cold build of the command,
time of the same after a one-line change in src/fit/fit.cpp. --beside: the cold build of another commit in the same run."""
import os
import shutil
import subprocess
import sys
import tempfile

import harness

RUNS, NEEDS_IDENTIFY, SOURCES = 1, False, ["CMakeLists.txt", "src/CMakeLists.txt"]
OPTIONS = {"--beside": {"metavar": "COMMIT"},
           "--test": {"action": "store_true", "help": "scripts/test from a clean checkout too (minutes)"},
           "--bare": {"action": "store_true", "help": "scripts/run up to its first number in a new Debian 12 root (as root)"}}
BUILD = ["cmake", "--build", "--preset", "release", "--target", "identify"]


def bare_root(work, clone):
    root = os.path.join(work, "root")
    harness.measured(["debootstrap", "--variant=minbase", "--include=ca-certificates", "bookworm", root])
    shutil.copytree(clone, os.path.join(root, "tribofit"), symlinks=True)
    for file in ("apt.conf.d", "sources.list", "sources.list.d", "../resolv.conf"):
        subprocess.run(["cp", "-rL", f"/etc/apt/{file}", f"{root}/etc/apt/{file}"], check=False)
    return ["chroot", root, "/tribofit/scripts/run"]


def run(given):
    if given.bare and not shutil.which("debootstrap"):
        sys.exit("bench build: --bare needs debootstrap: scripts/setup package")
    subprocess.run([harness.REPO / "scripts/setup"], check=True)
    os.environ["CCACHE_DISABLE"] = "1"
    harness.print_machine(given)
    table = harness.Table(what="-56", wall_s="8.1f", cpu_s="8.1f")

    def row(name, command, **more):
        use = harness.measured(command, **more)
        table.row(name, use.wall, use.processor)

    with tempfile.TemporaryDirectory() as work:
        for commit in (["HEAD", given.beside] if given.beside else ["HEAD"]):
            clone = os.path.join(work, commit.replace("/", "-"))
            subprocess.run(["git", "clone", "-q", harness.REPO, clone], check=True)
            named = harness.measured(["git", "rev-parse", commit], cwd=harness.REPO).text.strip()
            subprocess.run(["git", "checkout", "-q", named], cwd=clone, check=True)
            row(f"configure {commit}", ["cmake", "--preset", "release"], cwd=clone)
            row(f"cold build of identify, {commit}", BUILD, cwd=clone)
        clone = os.path.join(work, "HEAD")
        with open(os.path.join(clone, "src/fit/fit.cpp"), "a", encoding="utf-8") as file:
            file.write("// one line more\n")
        row("one line of src/fit/fit.cpp changed", BUILD, cwd=clone)
        subprocess.run(["git", "checkout", "-q", "."], cwd=clone, check=True)
        shutil.rmtree(os.path.join(clone, "build"))
        if given.test:
            row("scripts/test, from nothing", ["scripts/test"], cwd=clone)
            shutil.rmtree(os.path.join(clone, "build"))
        if given.bare:
            row("scripts/run in a new Debian root, to its first number", bare_root(work, clone))
