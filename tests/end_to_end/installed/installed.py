"""installed.py program|libraries|package|python BUILD CMAKE: installs a build into a folder of its own and uses it there."""
import gzip
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

what, build, cmake = sys.argv[1], Path(sys.argv[2]), sys.argv[3]
here = Path(__file__).resolve().parent
version = re.search(r"CMAKE_PROJECT_VERSION:STATIC=(\S+)", (build / "CMakeCache.txt").read_text()).group(1)
DIGITS = 1e-13  # relative; the example solves by shooting, the program from the phases of events


def run(*command, **options):
    done = subprocess.run([str(each) for each in command], capture_output=True, text=True, **options)
    assert done.returncode == 0, f"{command}: {done.returncode}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def install(prefix, component):
    run(cmake, "--install", build, "--prefix", prefix, "--component", component)


def commands(program):
    """Those that the help of the program lists."""
    part = run(program, "--help").split("\nCommands:\n")[1].split("\n\n")[0]
    return [line.split()[0] for line in part.splitlines()]


def completed_by_bash(script, words):
    shell = (f"source {script}; COMP_WORDS=({' '.join(words)}); COMP_CWORD={len(words) - 1}; _frahm; "
             'printf "%s\\n" "${COMPREPLY[@]}"')
    return run("bash", "-c", shell).split()


def completions(prefix, program):
    script = prefix / "share/bash-completion/completions/frahm"
    assert set(commands(program)) <= set(completed_by_bash(script, ["frahm", "''"]))
    assert completed_by_bash(script, ["frahm", "br"]) == ["branch"]
    assert completed_by_bash(script, ["frahm", "run", "--time"]) == ["--time-budget"]
    assert completed_by_bash(script, ["frahm", "point", "--path", "g"]) == ["general"]
    assert completed_by_bash(script, ["frahm", "help", "tu"]) == ["tune"]
    for command in commands(program):
        offered = completed_by_bash(script, ["frahm", command, "--"])
        assert "--help" in offered, command
        assert all(option in run(program, command, "--help") for option in offered), command
    if shutil.which("zsh"):
        run("zsh", "-n", prefix / "share/zsh/vendor-completions/_frahm")
    if shutil.which("fish"):
        script = prefix / "share/fish/vendor_completions.d/frahm.fish"
        offered = run("fish", "-c", f"source {script}; complete -C 'frahm point --pa'")
        assert "--path" in offered, offered


def manual(prefix, program):
    pages = prefix / "share/man/man1"
    for command in ["", *commands(program)]:
        page = pages / ("frahm-" + command + ".1.gz" if command else "frahm.1.gz")
        text = gzip.open(page, "rt").read()
        assert text.startswith(".\\\" DO NOT MODIFY") and ".SH SYNOPSIS" in text, page
        assert "Examples" in text or "EXAMPLES" in text or not command, page
    if shutil.which("man"):
        warned = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", "-Tutf8", str(pages / "frahm-run.1.gz")],
                                capture_output=True, text=True, env={**os.environ, "MANWIDTH": "80", "LC_ALL": "C.UTF-8"})
        assert warned.returncode == 0 and not warned.stderr, warned.stderr


def try_program(folder):
    install(folder, "program")
    program = folder / "bin/frahm"
    assert run(program, "--version").strip() == f"frahm {version}"
    assert f"version: {version}" in (folder / "share/doc/frahm/CITATION.cff").read_text()
    study = folder / "share/frahm/studies/classics/den_hartog.toml"
    assert json.loads(run(program, "point", study, "--at", "r=0.9,f=0.1", "--json"))
    for each in sorted((folder / "share/frahm/studies").glob("tuning/*.toml")):
        run(program, "check", each)
    completions(folder, program)
    if list(build.glob("installed/man/*")):
        manual(folder, program)


def try_libraries(folder):
    prefix, made = folder / "installed", folder / "example"
    install(prefix, "program")
    install(prefix, "development")
    lines = (here / "example/peak.cpp").read_text().splitlines()
    assert len(lines) <= 25, "the example is to stay short"
    study = prefix / "share/frahm/studies/classics/den_hartog.toml"
    point = ("r=0.9,f=0.1",)
    report = json.loads(run(prefix / "bin/frahm", "point", study, "--at", *point, "--json"))
    expected = report["quantities"]["main_peak"]["value"]

    run(cmake, "-S", here / "example", "-B", made, f"-DCMAKE_PREFIX_PATH={prefix}")
    run(cmake, "--build", made)
    found = float(run(made / "peak", study, *point))
    assert abs(found - expected) <= DIGITS * expected, (found, expected)

    # Another minor version is not taken for this one.
    refused = subprocess.run([cmake, "-S", here / "example", "-B", folder / "other", f"-DCMAKE_PREFIX_PATH={prefix}",
                              "-DFRAHM_ASKED=9.9"], capture_output=True, text=True)
    assert refused.returncode != 0 and "9.9" in refused.stderr

    environment = {**os.environ, "PKG_CONFIG_PATH": str(prefix / "lib/pkgconfig")}
    assert run("pkg-config", "--modversion", "frahm", env=environment).strip() == version
    flags = run("pkg-config", "--cflags", "--libs", "--static", "frahm", env=environment).split()
    run("c++", "-O1", here / "example/peak.cpp", "-o", made / "peak_pc", *flags)
    assert float(run(made / "peak_pc", study, *point)) == found


def try_package(folder):
    run("cpack", "-G", "DEB", "--config", build / "CPackConfig.cmake", "-B", folder)
    packages = {each.name.split("_")[0]: each for each in folder.glob("*.deb")}
    with_python = (build / "python").exists()
    assert set(packages) == {"frahm", "libfrahm-dev"} | ({"python3-frahm"} if with_python else set()), packages
    fields = run("dpkg-deb", "--field", packages["frahm"])
    assert f"Version: {version}" in fields and "libhdf5-103" in fields, fields
    root = folder / "root"
    for package in packages.values():
        run("dpkg-deb", "--extract", package, root)
    assert run(root / "usr/bin/frahm", "--version").strip() == f"frahm {version}"
    assert (root / "usr/lib/cmake/frahm/frahm-config.cmake").exists()
    assert (root / "usr/include/frahm/studies/reading/study/study.hpp").exists()
    if with_python:
        fields = run("dpkg-deb", "--field", packages["python3-frahm"])
        assert "python3-numpy" in fields and "libhdf5-103" in fields, fields
        assert list(root.glob("usr/lib/python3/dist-packages/frahm/_frahm.*.so"))
        assert os.access(root / "usr/lib/python3/dist-packages/frahm/check_file", os.X_OK)
        assert (root / "usr/share/frahm/studies/python/notebooks/atlas.ipynb").exists()


def try_python(folder):
    install(folder, "python")
    install(folder, "program")
    package, = folder.glob("lib/python3*/*-packages")
    python = re.search(r"Python_EXECUTABLE:FILEPATH=(\S+)", (build / "CMakeCache.txt").read_text()).group(1)
    script = "import frahm, sys; print(frahm.Study.load(sys.argv[1]).point(r=0.9, f=0.1)['main_peak'])"
    study = folder / "share/frahm/studies/classics/den_hartog.toml"
    found = float(run(python, "-c", script, study, env={**os.environ, "PYTHONPATH": str(package)}))
    report = json.loads(run(folder / "bin/frahm", "point", study, "--at", "r=0.9,f=0.1", "--json"))
    assert found == report["quantities"]["main_peak"]["value"], found


with tempfile.TemporaryDirectory() as temporary:
    {"program": try_program, "libraries": try_libraries, "package": try_package, "python": try_python}[what](Path(temporary))
