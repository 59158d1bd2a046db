#!/usr/bin/env python3
"""Interrupts batches at random moments and runs them again: the results must be the bytes of a run that nobody
interrupted, and nothing may be left behind. Interruptions: SIGTERM, SIGINT, SIGKILL, a full disc (a limit on the size of
files), a folder that may not be written, a folder that vanishes, a second batch into the same folder, a second batch on
another host whose clock is an hour ahead, on a file system without locks (simulated by a preloaded library), and a shard
that is killed and repeated.
usage: kills.py IDENTIFY [COUNT] [SEED]   (default: 200 1; some minutes)
"""
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts/benches"))
import harness

NO_LOCKS = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
int flock(int file, int how) { (void)file; (void)how; errno = ENOLCK; return -1; }
int gethostname(char *name, size_t size) { strncpy(name, getenv("SIMULATED_HOST"), size); return 0; }
int clock_gettime(clockid_t clock, struct timespec *time) {
  static int (*real)(clockid_t, struct timespec *);
  if (!real) real = (int (*)(clockid_t, struct timespec *))dlsym(RTLD_NEXT, "clock_gettime");
  const int status = real(clock, time);
  if (clock == CLOCK_REALTIME) time->tv_sec += atoi(getenv("SIMULATED_AHEAD"));
  return status;
}
"""


class Batches:
    """Batches of twelve runs in the current folder. Root may write everywhere: then nobody runs them."""

    def __init__(self, identify):
        self.who = {"user": 65534, "group": 65534, "extra_groups": []} if os.geteuid() == 0 else {}
        self.identify = os.path.abspath(shutil.copy(identify, "identify"))
        os.chmod(self.identify, 0o755)
        os.mkdir("runs")
        for k in range(12):
            subprocess.run([self.identify, "simulate", "--quiet", "--duration", "2s", "--rate", "2kHz", "--noise-mu", "0.003",
                            "--scatter", "0.004", "--seed", str(k + 1), "--out", f"runs/r{k:02}.csv"], check=True)
            os.remove(f"runs/r{k:02}.json")
        begin = time.monotonic()
        self.start(folder="reference").wait()
        self.seconds, self.reference = time.monotonic() - begin, harness.files_of("reference")

    def start(self, *more, folder="results", **how):
        words = [self.identify, "--radius", "15mm", "--quiet", "--threads", "2", "--out", folder, *more, "runs"]
        return subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **self.who, **how)

    def begin(self, *more, **how):
        batch = self.start(*more, **how)
        time.sleep(random.random() * 0.95 * self.seconds)
        return batch

    def signalled(self, number):
        batch = self.begin()
        batch.send_signal(number)
        batch.wait()

    def full_disc(self):
        most = random.randrange(1, max(map(len, self.reference.values())))

        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))

        self.start(preexec_fn=limit, restore_signals=False).wait()

    def read_only(self):
        batch = self.begin()
        folders = [path for path, _, _ in os.walk("results")]
        for folder in folders:
            os.chmod(folder, 0o555)
        batch.wait()
        for folder in folders:
            os.chmod(folder, 0o755)

    def vanished(self):
        batch = self.begin()
        shutil.rmtree("results", ignore_errors=True)
        batch.wait()

    def two_at_once(self, environments=(None, None)):
        for batch in [self.begin(env=environments[0]), self.start(env=environments[1])]:
            batch.wait()

    def without_locks(self):
        if not os.path.exists("no-locks.so"):
            subprocess.run(["cc", "-shared", "-fPIC", "-o", "no-locks.so", "-x", "c", "-", "-ldl"], input=NO_LOCKS,
                           text=True, check=True)
        self.two_at_once([{**os.environ, "LD_PRELOAD": os.path.abspath("no-locks.so"), "SIMULATED_HOST": host,
                           "SIMULATED_AHEAD": ahead} for host, ahead in (("one", "0"), ("two", "3600"))])

    def repeated_shard(self):
        shards = random.sample(["1/3", "2/3", "3/3"], 3)
        batch = self.begin("--shard", shards[0])
        batch.kill()
        batch.wait()
        for shard in [*shards, shards[0]]:
            self.start("--shard", shard).wait()
        subprocess.run([self.identify, "merge", "--quiet", "results"], stderr=subprocess.DEVNULL, check=False, **self.who)


def main(identify, count=200, seed=1):
    random.seed(int(seed))
    identify, count = os.path.realpath(identify), int(count)
    left = differ = 0
    with tempfile.TemporaryDirectory() as scratch:
        os.chmod(scratch, 0o777)
        os.chdir(scratch)
        batches = Batches(identify)
        kinds = {"SIGTERM": lambda: batches.signalled(signal.SIGTERM), "SIGINT": lambda: batches.signalled(signal.SIGINT),
                 "SIGKILL": lambda: batches.signalled(signal.SIGKILL), "full disc": batches.full_disc,
                 "read-only folder": batches.read_only, "vanished folder": batches.vanished,
                 "two batches at once": batches.two_at_once, "two hosts without locks": batches.without_locks,
                 "shard killed and repeated": batches.repeated_shard}
        for k in range(count):
            kind = list(kinds)[k % len(kinds)]
            shutil.rmtree("results", ignore_errors=True)
            kinds[kind]()
            # What was begun before cannot be removed after SIGKILL or from such a folder, but by the next run.
            found = [] if kind in ("SIGKILL", "read-only folder") else [x for x in harness.files_of("results") if x.endswith(".part")]
            if kind != "shard killed and repeated":
                batches.start().wait()
            now = harness.files_of("results")
            others = [x for x in sorted({*now, *batches.reference}) if now.get(x) != batches.reference.get(x)]
            if found or others:
                print(f"{k}: {kind}: left {found}, other than in the reference: {others}", file=sys.stderr)
            left += bool(found)
            differ += bool(others)
        os.chdir("/")
    print(f"{count} interruptions of {len(kinds)} kinds: something left after {left}, other bytes after the next run {differ}")
    return int(left + differ > 0)


sys.exit(main(*sys.argv[1:]))
