"""What every benchmark needs: records, one way of timing, one way of printing, and a workbench to talk to."""
import atexit
import collections
import http.client
import json
import os
import pathlib
import platform
import re
import signal
import statistics
import subprocess
import sys
import time

REPO = pathlib.Path(__file__).resolve().parents[2]
CONDITIONS = ["--radius", "15mm", "--speed", "4rpm"]
NOISE = ["--noise-mu", "0.003", "--noise-v", "0.2mm/s", "--scatter", "0.003"]
LAG = ["--effect", "frictional-lag:tau=2ms"]

Used = collections.namedtuple("Used", "wall processor memory status text")  # [s], [s], [MB]


def used(command, **more):
    """What one run of a command takes, how it ends and what it prints."""
    begin = time.monotonic()
    child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, **more)
    text = child.stdout.read()
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    return Used(time.monotonic() - begin, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024 / 1e6, child.returncode, text)


def median(runs):
    return Used(*(statistics.median(getattr(run, name) for run in runs) for name in ("wall", "processor", "memory")),
                runs[-1].status, runs[-1].text)


def measured(command, runs=1, **more):
    """The median; ends the benchmark where the command fails."""
    out = median([used(command, **more) for _ in range(runs)])
    if out.status != 0:
        sys.exit(f"bench: status {out.status}: {' '.join(map(str, command))}"[:400])
    return out


def record(identify, file, duration="20s", rate="20kHz", options=(*CONDITIONS, *NOISE, *LAG)):
    """Simulates one; the usual one has a lag to be found, in noise."""
    subprocess.run([identify, "simulate", *options, "--duration", duration, "--rate", rate, "--quiet", "--out", file], check=True)


def copies(trace, folder, names, lines_less=1):
    """Copies that end earlier and earlier: one that holds the same values as another would count once."""
    os.mkdir(folder)
    lines = pathlib.Path(trace).read_text(encoding="utf-8").splitlines(keepends=True)
    for k, name in enumerate(names):
        pathlib.Path(folder, name).write_text("".join(lines[: len(lines) - lines_less * k]), encoding="utf-8")


def files_of(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in pathlib.Path(folder).rglob("*") if path.is_file()}


def print_machine(given):
    commit = subprocess.run(["git", "-C", REPO, "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False)
    print(f"{platform.machine()}, {os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}, {given.runs} runs each, "
          f"commit {commit.stdout.strip() or 'unknown'}\n", flush=True)


class Table:
    """Rows below their names; each column has its format: "-38" of words, "7.2f" of numbers."""

    def __init__(self, **columns):
        self.formats = list(columns.values())
        widths = [re.match(r"-?(\d+)", one)[1] for one in self.formats]
        names = [name.replace("_", " ") for name in columns]
        print("  ".join(f"{name:{'<' if one.startswith('-') else '>'}{width}}"
                        for name, one, width in zip(names, self.formats, widths)).rstrip(), flush=True)

    def row(self, *cells):
        print("  ".join(f"{cell[:int(one[1:])]:<{one[1:]}}" if one.startswith("-") else
                        f"{'' if cell is None else cell:>{one if cell is not None else one.split('.')[0]}}"
                        for cell, one in zip(cells, self.formats)).rstrip(), flush=True)


class Workbench:
    """`identify explore`, asked as its page asks."""

    LONG = "+".join(f"k*(v/w)^.{i}" for i in range(100, 700))  # a formula that takes long

    def __init__(self, identify, trace, folder=None):
        self.server = subprocess.Popen([identify, "explore", *CONDITIONS, trace], stdout=subprocess.PIPE, text=True, cwd=folder)
        atexit.register(self.server.kill)
        said = ""
        while "Ctrl-C" not in said:
            said += self.server.stdout.readline()
        found = re.search(r"http://127\.0\.0\.1:(\d+)/\?token=([0-9a-f]+)", said)
        self.address, self.port, self.token = found[0], int(found[1]), found[2]
        self.turn = 0

    def ask(self, method, path, body=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=300)
        headers = {"X-Workbench-Token": self.token, "Content-Type": "application/json"}
        connection.request(method, path, json.dumps(body) if body is not None else None, headers)
        answer = connection.getresponse().read()
        self.arrived = time.monotonic()
        connection.close()
        return json.loads(answer)

    @staticmethod
    def choice(effects=(), formulas=()):
        return {"law": "exponential", "effects": list(effects), "formulas": list(formulas)}

    def show(self, effects=(), formulas=(), full=False):
        """Time to the answer [ms], and the answer; none where the server ends meanwhile."""
        self.turn += 1
        begin = time.monotonic()
        try:
            answer = self.ask("POST", "/api/show", {"page": "bench", "turn": self.turn, "full": full, "passing": True,
                                                    "choice": self.choice(effects, formulas)})
        except (OSError, http.client.HTTPException, ValueError):
            return None, {}
        return 1e3 * (self.arrived - begin), answer

    def diagnose(self, formulas):
        return self.ask("POST", "/api/diagnose", {"choice": self.choice([], formulas)})

    def cancelled_after(self):
        """Time from Cancel until no diagnosis is under way [ms]."""
        begin = time.monotonic()
        self.ask("POST", "/api/cancel", {})
        while self.ask("GET", "/api/diagnosis")["state"] == "running":
            time.sleep(0.001)
        return 1e3 * (time.monotonic() - begin)

    def ended_after(self, sent=signal.SIGTERM):
        """Time from a signal to the end [ms]."""
        begin = time.monotonic()
        self.server.send_signal(sent)
        self.server.wait()
        return 1e3 * (time.monotonic() - begin)

    def megabytes(self):
        status = pathlib.Path(f"/proc/{self.server.pid}/status").read_text(encoding="utf-8")
        return int(re.search(r"VmRSS:\s+(\d+)", status)[1]) / 1024
