#!/usr/bin/env python3
"""Checks that data flow downwards only: a module includes itself and modules above it, never below.

Public headers include the standard library and tribofit only, so that using the library needs no other package.

usage: layering.py REPOSITORY      exit status 1 and one line per offence when the order is broken
       layering.py --self-test     proves on made-up trees that each rule can fail
"""

import pathlib
import re
import sys

import contract

# In the order in which data flow. The pipeline is no directory but include/tribofit/pipeline.hpp and src/pipeline.cpp: it
# calls the modules above it for one trace; what deals with many traces or with its results lies below it.
MODULES = ["execution", "statistics", "output", "ingest", "instruments", "kinematics", "segmentation", "friction", "oscillator", "fit",
         "diagnosis", "study", "pipeline", "campaign", "report", "workbench"]
# What a module must know nothing of, as it would appear in an #include.
STRANGERS = {
    "friction": {"CSV": r"fast_float/.*"},
    "report": {"Ceres": r"ceres/.*", "the integrator": r"boost/numeric/odeint.*"},
}
PUBLIC = re.compile(r"tribofit/.*|[a-z_]+")
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
SOURCE_SUFFIXES = {".hpp", ".cpp", ".h", ".inc"}


def module_of_include(target):
    """The module a header belongs to, None for what is not ours."""
    if target == "tribofit/pipeline.hpp":
        return "pipeline"
    parts = target.removeprefix("tribofit/").split("/")
    return parts[0] if len(parts) > 1 and parts[0] in MODULES else None


def offences_of_file(path, module, public):
    offences = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        target = match.group(1)
        other = module_of_include(target)
        if other and MODULES.index(other) > MODULES.index(module):
            offences.append(f"{path}:{number}: {module} includes {target}, which lies below it")
        if public and not PUBLIC.fullmatch(target):
            offences.append(f"{path}:{number}: a public header includes {target}, which users may not have")
        for stranger, pattern in STRANGERS.get(module, {}).items():
            if re.fullmatch(pattern, target):
                offences.append(f"{path}:{number}: {module} includes {target}, but must know nothing of {stranger}")
    return offences


def offences(repository):
    found = []
    for base, public in ((repository / "include" / "tribofit", True), (repository / "src", False)):
        for path in sorted(base.glob("pipeline.*")):
            found += offences_of_file(path, "pipeline", public)
        for directory in sorted(entry for entry in base.iterdir() if entry.is_dir()):
            if directory.name not in MODULES:
                found.append(f"{directory}: not a module; the modules are {', '.join(MODULES)}")
                continue
            for path in sorted(directory.rglob("*")):
                if path.suffix in SOURCE_SUFFIXES:
                    found += offences_of_file(path, directory.name, public)
    return found


def with_file(name, text):
    """A tree of modules without includes and one more file."""
    return {"include/tribofit/fit/fit.hpp": "", "src/fit/fit.cpp": "", name: text}


TREES = [  # files, number of offences
    (with_file("src/report/a.cpp", '#include "tribofit/ingest/trace.hpp"\n#include <vector>\n'), 0),
    (with_file("src/fit/a.cpp", '#include <ceres/ceres.h>\n#include "fit/a.hpp"\n'), 0),
    (with_file("src/ingest/a.cpp", "#include <fast_float/fast_float.h>\n"), 0),
    (with_file("src/ingest/a.cpp", '// #include "tribofit/report/table.hpp"\n'), 0),
    (with_file("src/ingest/a.cpp", '#include "tribofit/fit/fit.hpp"\n'), 1),
    (with_file("src/ingest/a.cpp", '  #  include <tribofit/kinematics/motion.hpp>\n'), 1),
    (with_file("src/friction/a.cpp", '#include "oscillator/integrator.hpp"\n'), 1),
    (with_file("src/report/a.cpp", '#include "tribofit/pipeline.hpp"\n'), 0),
    (with_file("src/fit/a.cpp", '#include "tribofit/pipeline.hpp"\n'), 1),
    (with_file("src/pipeline.cpp", '#include "tribofit/report/terminal.hpp"\n'), 1),
    (with_file("include/tribofit/friction/effects/a.hpp", '#include "tribofit/fit/fit.hpp"\n'), 1),
    (with_file("src/friction/a.cpp", '#include <fast_float/fast_float.h>\n'), 1),
    (with_file("src/report/a.cpp", "#include <ceres/jet.h>\n"), 1),
    (with_file("src/ingest/a.cpp", '#include "tribofit/statistics/quantiles.hpp"\n'), 0),
    (with_file("src/fit/a.cpp", '#include "statistics/linear_algebra.hpp"\n'), 0),
    (with_file("src/statistics/a.cpp", '#include "tribofit/ingest/trace.hpp"\n'), 1),
    (with_file("include/tribofit/fit/a.hpp", "#include <vector>\n"), 0),
    (with_file("include/tribofit/fit/a.hpp", "#include <Eigen/Core>\n"), 1),
    (with_file("src/util/a.cpp", ""), 1),
]


if __name__ == "__main__":
    sys.exit(contract.run("layering", __doc__, offences, TREES))
