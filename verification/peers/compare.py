#!/usr/bin/python3
"""PFHub 1d by traceraft, PETSc TS and FEniCS: error of the energy, CPU time and memory, one thread.

Runs one program after the other and prints a row of a Markdown table for each. Needs the Debian
packages python3-petsc4py, python3-dolfin and python3-scipy; without them --programs traceraft.

usage: compare.py [--traceraft build/release/traceraft] [--programs traceraft,petsc,fenics] [--repeat 1]
"""
import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
# By spherical harmonics on this branch of the azimuth, [0, 2 pi); `traceraft verify pfhub` has the other
# one. The times are those at which the programs of problem.py report.
TIMES = (1.0, 10.0, 100.0, 1000.0)
ENERGIES = (925.4, 658.3, 390.724, 210.412)
# What is run: size of the mesh, end, tolerance (FEniCS: first step).
RUNS = {"traceraft": [(64, 1000, 1e-3), (88, 1000, 1e-3), (48, 100, 1e-3), (64, 100, 1e-3)],
        "petsc": [(5, 1000, 1e-3), (6, 100, 1e-3)],
        "fenics": [(5, 1000, 1.0), (6, 100, 1.0)]}
INITIAL = ("0.5+0.05*(cos(8*{theta})*cos(15*{phi})+(cos(12*{theta})*cos(10*{phi}))^2"
           "+cos(2.5*{theta}-1.5*{phi})*cos(7*{theta}-2*{phi}))").format(
               theta="acos(z/sqrt(x^2+y^2+z^2))", phi="(atan2(y,x)+(y<0?6.283185307179586:0))")
# Units of traceraft: R = 100, R^2/D = 2000, and energies over R^2.
LENGTH, TIME = 100.0, 2000.0


def traceraft_command(program, size, t_end, tolerance, folder):
    times = ",".join(f"{t / TIME:g}" for t in TIMES if t <= t_end)
    return [program, "run", "--quiet", "--scaled", "--cells", str(size), "--epsilon",
            repr(2 ** 0.5 / LENGTH), "--well", "rho=5,a=0.3,b=0.7", "--mobility",
            "constant:value=1", "--initial", "formula", "--initial-formula", INITIAL, "--t-end",
            f"{t_end / TIME:g}", "--output-times", times, "--tolerance", str(tolerance),
            "--no-fields", "--threads", "1", "--out", folder]


def command(name, options, run, folder):
    if name == "traceraft":
        return traceraft_command(options.traceraft, *run, folder)
    script = {"petsc": "petsc_ts.py", "fenics": "fenics_euler.py"}[name]
    return ["/usr/bin/python3", str(HERE / script)] + [f"{value:g}" for value in run]


def energies_of(name, output, folder):
    if name != "traceraft":
        return {float(w[1]): float(w[2]) for w in map(str.split, output.splitlines())
                if w and w[0] == "energy"}
    with open(os.path.join(folder, "observables.csv")) as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        return {round(float(row["t (R^2/D)"]) * TIME, 6): float(row["energy (R^2)"]) * LENGTH ** 2 for row in rows}


def nodes_of(name, output, folder):
    if name == "traceraft":
        with open(os.path.join(folder, "summary.json")) as file:
            return json.load(file)["nodes"]
    return [int(w[1]) for w in map(str.split, output.splitlines()) if w and w[0] == "nodes"][0]


def measured(name, options, run):
    """(nodes, errors in percent, CPU seconds, MB) of one run in a process of its own."""
    with tempfile.TemporaryDirectory() as parent:
        folder = os.path.join(parent, "run")
        environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
        with open(os.path.join(parent, "output"), "w+") as output:
            process = subprocess.Popen(command(name, options, run, folder), stdout=output,
                                       stderr=subprocess.DEVNULL, env=environment)
            _, status, usage = os.wait4(process.pid, 0)
            output.seek(0)
            text = output.read()
        if status != 0:
            sys.exit(f"{name} failed: {' '.join(command(name, options, run, folder))}")
        energies = energies_of(name, text, folder)
        errors = [100 * (energies[t] / reference - 1) for t, reference in zip(TIMES, ENERGIES)
                  if t <= run[1]]
        return (nodes_of(name, text, folder), errors, usage.ru_utime + usage.ru_stime,
                usage.ru_maxrss / 1024)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--traceraft", default=str(HERE.parents[1] / "build/release/traceraft"))
    parser.add_argument("--programs", default="traceraft,petsc,fenics")
    parser.add_argument("--repeat", type=int, default=1, help="rounds; CPU times are medians")
    options = parser.parse_args()
    names = options.programs.split(",")
    if unknown := [name for name in names if name not in RUNS]:
        parser.error(f"unknown program '{unknown[0]}'; valid: {', '.join(RUNS)}")
    print("| to t | program | mesh | nodes | error in % at t = 1, 10, 100, 1000 | CPU s | MB |")
    print("|---|---|---|---|---|---|---|")
    runs = [(name, run) for name in names for run in RUNS[name]]
    results = {}
    for _ in range(options.repeat):  # interleaved, so that a busy machine is busy for all
        for key in runs:
            results.setdefault(key, []).append(measured(key[0], options, key[1]))
    for name, run in sorted(runs, key=lambda key: -key[1][1]):
        nodes, errors, _, memory = results[name, run][0]
        cpu = sorted(result[2] for result in results[name, run])[options.repeat // 2]
        print(f"| {run[1]} | {name} | {run[0]} | {nodes:,} | "
              f"{', '.join(f'{error:+.1f}' for error in errors)} | {cpu:.1f} | {memory:.0f} |")


main()
