#!/usr/bin/env python3
"""Checks that data flow downwards only: a room includes itself and rooms above it, never below.

The room `statistics` knows numbers only: it includes no other room, and every room may include it.
Public headers include the standard library and tribofit only, so that using the library needs no other package.

usage: layering.py REPOSITORY      exit status 1 and one line per offence when the order is broken
       layering.py --self-test     proves on made-up trees that each rule can fail
"""

import pathlib
import re
import sys
import tempfile

# In the order in which data flow. The pipeline is no directory but include/tribofit/pipeline.hpp and src/pipeline.cpp: it
# calls the rooms above it for one trace; what deals with many traces or with its results lies below it.
ROOMS = ["ingest", "statistics", "kinematics", "segmentation", "friction", "oscillator", "fit", "diagnosis", "study", "pipeline",
         "campaign", "report", "workbench"]
# Numbers in, numbers out: it includes no other room, and so any room may include it, those above it too.
FOUNDATION = "statistics"
# What a room must know nothing of, as it would appear in an #include.
STRANGERS = {
    "friction": {"CSV": r"(libfccp/)?csv\.h"},
    "report": {"Ceres": r"ceres/.*", "the integrator": r"boost/numeric/odeint.*"},
}
PUBLIC = re.compile(r"tribofit/.*|[a-z_]+")
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
SOURCE_SUFFIXES = {".hpp", ".cpp", ".h", ".inc"}


def room_of_include(target):
    """The room a header belongs to, None for what is not ours."""
    if target == "tribofit/pipeline.hpp":
        return "pipeline"
    parts = target.removeprefix("tribofit/").split("/")
    return parts[0] if len(parts) > 1 and parts[0] in ROOMS else None


def offences_of_file(path, room, public):
    offences = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        target = match.group(1)
        other = room_of_include(target)
        if other and room == FOUNDATION != other:
            offences.append(f"{path}:{number}: {room} includes {target}, but knows no other room")
        elif other and other != FOUNDATION and ROOMS.index(other) > ROOMS.index(room):
            offences.append(f"{path}:{number}: {room} includes {target}, which lies below it")
        if public and not PUBLIC.fullmatch(target):
            offences.append(f"{path}:{number}: a public header includes {target}, which users may not have")
        for stranger, pattern in STRANGERS.get(room, {}).items():
            if re.fullmatch(pattern, target):
                offences.append(f"{path}:{number}: {room} includes {target}, but must know nothing of {stranger}")
    return offences


def offences(repository):
    found = []
    for base, public in ((repository / "include" / "tribofit", True), (repository / "src", False)):
        for path in sorted(base.glob("pipeline.*")):
            found += offences_of_file(path, "pipeline", public)
        for directory in sorted(entry for entry in base.iterdir() if entry.is_dir()):
            if directory.name not in ROOMS:
                found.append(f"{directory}: not a room; the rooms are {', '.join(ROOMS)}")
                continue
            for path in sorted(directory.rglob("*")):
                if path.suffix in SOURCE_SUFFIXES:
                    found += offences_of_file(path, directory.name, public)
    return found


def self_test():
    cases = [  # file, its text, whether it must be refused
        ("src/report/a.cpp", '#include "tribofit/ingest/trace.hpp"\n#include <vector>\n', False),
        ("src/fit/a.cpp", '#include <ceres/ceres.h>\n#include "fit/a.hpp"\n', False),
        ("src/ingest/a.cpp", "#include <libfccp/csv.h>\n", False),
        ("src/ingest/a.cpp", '// #include "tribofit/report/table.hpp"\n', False),
        ("src/ingest/a.cpp", '#include "tribofit/fit/fit.hpp"\n', True),
        ("src/ingest/a.cpp", '  #  include <tribofit/kinematics/motion.hpp>\n', True),
        ("src/friction/a.cpp", '#include "oscillator/integrator.hpp"\n', True),
        ("src/report/a.cpp", '#include "tribofit/pipeline.hpp"\n', False),
        ("src/fit/a.cpp", '#include "tribofit/pipeline.hpp"\n', True),
        ("src/pipeline.cpp", '#include "tribofit/report/terminal.hpp"\n', True),
        ("include/tribofit/friction/effects/a.hpp", '#include "tribofit/fit/fit.hpp"\n', True),
        ("src/friction/a.cpp", '#include <libfccp/csv.h>\n', True),
        ("src/report/a.cpp", "#include <ceres/jet.h>\n", True),
        ("src/ingest/a.cpp", '#include "tribofit/statistics/quantiles.hpp"\n', False),
        ("src/fit/a.cpp", '#include "statistics/linear_algebra.hpp"\n', False),
        ("src/statistics/a.cpp", '#include "tribofit/ingest/trace.hpp"\n', True),
        ("include/tribofit/fit/a.hpp", "#include <vector>\n", False),
        ("include/tribofit/fit/a.hpp", "#include <Eigen/Core>\n", True),
        ("src/util/a.cpp", "", True),
    ]
    wrong = 0
    for name, text, refused in cases:
        with tempfile.TemporaryDirectory() as directory:
            root = pathlib.Path(directory)
            (root / "include" / "tribofit").mkdir(parents=True)
            (root / "src").mkdir()
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
            if bool(offences(root)) != refused:
                print(f"{name} with {text!r} should {'' if refused else 'not '}have been refused")
                wrong += 1
    print(f"layering: {len(cases) - wrong} of {len(cases)} made-up trees judged rightly")
    return wrong == 0


def main(arguments):
    if arguments == ["--self-test"]:
        return 0 if self_test() else 1
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    found = offences(pathlib.Path(arguments[0]))
    print("\n".join(found) if found else "layering: no offences")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
