"""How soon `identify` ends when it is told to: SIGINT and SIGTERM at several moments of every verb (a part of the time it
takes when nobody interrupts it), and, in the workbench, signals and Cancel in the middle of fits and diagnoses, with a
formula of 600 powers among them. Of each: how long it took to end [ms], beside what the system needs to end the same
process by SIGKILL (on a busy machine that is most of it), exit status as seen by the shell, and whatever is left
half-written: temporary files, and results that differ from those of a run that nobody interrupted.
Status 1 where an end took more than 100 ms, and more than the slowest by SIGKILL, where a status is wrong or something
half-written was left."""
import os
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time

import harness

RUNS, NEEDS_IDENTIFY, SOURCES = 1, True, ["src/pipeline.cpp", "src/statistics", "src/workbench"]
OPTIONS = {"--only": {"default": "", "metavar": "WORD", "help": "rows whose name holds this word"}}
FORMULA = f"long = {harness.Workbench.LONG}; k=0.001, w=6"
LONG = ["--formula", FORMULA]
MOMENTS = (0.03, 0.2, 0.4, 0.6, 0.8, 0.97)
PATIENCE = 12  # seconds that a run may take until it is interrupted
ALLOWED = 100  # ms
OPEN = ["--noise-mu", "0.006", "--noise-v", "0.2mm/s", "--scatter", "0.008", "--effect", "run-in:w=0.06,L=60mm"]
STEPS = ["--kind", "velocity-steps", "--rate-state", "a=0.01,b=0.014,D_c=10um,k=0.002/um", "--noise-mu", "0.0002"]
SPEEDS = "0s:2um/s,60s:10um/s,100s:2um/s,160s:10um/s"
# Verbs by name, in a folder where long.csv, trace.csv, open.csv, steps.csv, runs/ and results/ lie one level up.
VERBS = {
    "identify": "RECORD FILES ../long.csv",
    "identify, 600 powers": "RECORD LONG ../trace.csv",
    "diagnose": "diagnose RECORD FILES ../trace.csv",
    "diagnose, 2 minutes": "diagnose RECORD ../long.csv",
    "diagnose, 600 powers": "diagnose RECORD LONG ../trace.csv",
    "diagnose, time limit": "diagnose RECORD --time-limit 3s LONG ../trace.csv",
    "plan": "plan RECORD --report out.html ../open.csv",
    "velocity steps": f"--speed {SPEEDS} --json out.json --csv csv ../steps.csv",
    "batch": "RECORD --out out --report out.html ../runs",
    "batch, 600 powers": "RECORD LONG --out out ../runs",
    "merge": "merge --report out.html results",
    "study speed": "study speed --radius 15mm FILES",
    "study speed, trace": "study speed RECORD ../trace.csv",
    "study phase": "study phase --radius 15mm --at 2mm/s,6mm/s,20mm/s FILES",
    "study response": "study response --radius 15mm FILES",
    "study sensitivity": "study sensitivity --radius 15mm FILES",
    "study map": "study map --radius 15mm --x stiffness=8N/mm..20N/mm:40 --y mass=0.5kg..1.5kg:40 --csv map",
    "simulate": "simulate SIMULATED --duration 120s --out out.csv",
    "simulate, 600 powers": "simulate SIMULATED LONG --duration 120s --out out.csv",
    "twin": "twin RECORD --effect frictional-lag --json out.json --report out.html ../trace.csv",
    "twin, 2 minutes": "twin RECORD ../long.csv",
    "rig": "rig RECORD --json out.json ../long.csv",
    "columns": "columns ../long.csv",
    "manifest": "manifest ../runs --out manifest.csv",
    "effects": "effects frictional-lag",
    "explore, reading": "explore RECORD ../long.csv",
}
WORDS = {"RECORD": ["--radius", "15mm", "--load", "50N"], "LONG": LONG,
         "FILES": ["--json", "out.json", "--csv", "csv", "--report", "out.html", "--figures", "figures"],
         "SIMULATED": [*harness.CONDITIONS, *harness.NOISE, *harness.LAG, "--rate", "20kHz"]}
SERVED = {  # what the workbench works on when it is interrupted
    "idle": lambda bench: None,
    "full fit, 600 powers": lambda bench: bench.show([], [FORMULA], full=True),
    "look, 600 powers": lambda bench: bench.show([], [FORMULA]),
    "full fit, rate-state": lambda bench: bench.show(["rate-state", "contact-spin"], full=True),
    "diagnosis, 600 powers": lambda bench: bench.diagnose([FORMULA]),
}


class Ends:
    """How the interrupted runs of one row ended."""

    def __init__(self):
        self.times, self.kills, self.statuses, self.left = [], [], set(), set()

    def add(self, sent, took, status):
        (self.kills if sent == signal.SIGKILL else self.times).append(took)
        if sent != signal.SIGKILL and status is not None:
            self.statuses.add(128 - status if status < 0 else status)

    def show(self, table, name, wanted):
        wrong = sorted(self.statuses - wanted)
        late = max(self.times) > max(ALLOWED, *self.kills, 0)
        faults = [*(["late"] if late else []), *([f"status {wrong}"] if wrong else []), *sorted(self.left)]
        kills = (statistics.median(self.kills), max(self.kills)) if self.kills else (None, None)
        table.row(name, len(self.times), statistics.median(self.times), max(self.times), *kills,
                  " ".join(map(str, sorted(self.statuses))), "; ".join(faults) or "nothing left")
        return not faults


def half_written(found, whole):
    """Temporary files, and files that are not as the uninterrupted run left them (where that had time to end)."""
    for name, content in found.items():
        if name.endswith(".part"):
            yield f"{name} stayed"
        elif whole is not None and content != whole.get(name) and not name.endswith(".rows"):  # of a map: what is done
            yield f"{name} is half-written"


def interrupted(command, folder):
    """Runs a command whole, then again and again with a signal at the moments."""
    def begin():
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        if command[1] == "merge":
            shutil.copytree(os.path.join(folder, "../results"), os.path.join(folder, "results"))
        return subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))

    start, whole = time.monotonic(), None
    child = begin()
    try:
        status = child.wait(PATIENCE)
        if status not in (0, 1):
            sys.exit(f"bench stop: status {status}: {' '.join(command)}"[:400])
        whole = harness.files_of(folder)
    except subprocess.TimeoutExpired:
        child.kill()
        child.wait()
    took, ends = time.monotonic() - start, Ends()
    for sent in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
        for moment in MOMENTS:
            child = begin()
            time.sleep(moment * took)
            if child.poll() is not None:
                continue  # it was faster this time
            sending = time.monotonic()
            child.send_signal(sent)
            status = child.wait()
            ended = 1e3 * (time.monotonic() - sending)
            found = harness.files_of(folder)
            just_before = status == 0 and sorted(found) == sorted(whole or {})
            ends.add(sent, ended, None if just_before else status)
            if sent != signal.SIGKILL:
                ends.left.update(half_written(found, whole))
    return ends


def served(identify, trace, folder, asked):
    """Signals to the server while it works on what is asked."""
    ends = Ends()
    for sent in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
        for wait in (0.05, 0.3, 0.8):
            bench = harness.Workbench(identify, trace, folder)
            thread = threading.Thread(target=asked, args=(bench,))
            thread.start()
            time.sleep(wait)
            took = bench.ended_after(sent)
            ends.add(sent, took, bench.server.returncode)
            thread.join()
    return ends


def cancelled(identify, trace, folder, formulas):
    ends, bench = Ends(), harness.Workbench(identify, trace, folder)
    for wait in (0.02, 0.1, 0.2, 0.4, 0.8, 1.2, 1.6, 2.4):
        bench.diagnose(formulas)
        time.sleep(wait)
        ends.add(None, bench.cancelled_after(), 0)
    bench.ended_after(signal.SIGKILL)
    return ends


def run(given):
    good = True
    with tempfile.TemporaryDirectory() as base:
        def here(name):
            return os.path.join(base, name)

        harness.record(given.identify, here("long.csv"), "120s")
        harness.record(given.identify, here("trace.csv"))
        harness.record(given.identify, here("open.csv"), "10s", "5kHz", [*harness.CONDITIONS, *OPEN])
        harness.record(given.identify, here("steps.csv"), "220s", "100Hz", [*STEPS, "--speed-steps", SPEEDS])
        harness.copies(here("trace.csv"), here("runs"), [f"r{k}.csv" for k in range(8)], 10)
        harness.measured([given.identify, "--radius", "15mm", "--quiet", "--out", here("results"), here("runs")])
        harness.print_machine(given)
        table = harness.Table(**{"[ms]": "-30", "ends": "4d", "median": "7.0f", "slowest": "8.0f", "SIGKILL": "7.0f",
                                 "slowest_": "8.0f", "status": "-12", "left": "-40"})
        folder = here("here")
        for name, text in VERBS.items():
            if given.only in name:
                words = [word for part in text.split() for word in WORDS.get(part, [part])]
                ends = interrupted([given.identify, *words], folder)
                # The workbench ends in an orderly way once it serves.
                good &= not ends.times or ends.show(table, name, {130, 143, 0} if text.startswith("explore") else {130, 143})
        os.makedirs(folder, exist_ok=True)
        for name, asked in SERVED.items():
            if given.only in f"explore, {name}":
                good &= served(given.identify, here("trace.csv"), folder, asked).show(table, f"explore, {name}", {0})
        for name, trace, formulas in (("Cancel, 600 powers", "trace.csv", [FORMULA]), ("Cancel, 2 minutes", "long.csv", [])):
            if given.only in name:
                good &= cancelled(given.identify, here(trace), folder, formulas).show(table, name, {0})
    return int(not good)
