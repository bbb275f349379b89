"""Which Python the compiled module is built for, in the words of an error where another one imports it."""

import pathlib
import re
import sys


def explained(error):
    """The error that `import frahm` ends with: `error` itself, unless the module is there for another Python."""
    modules = sorted(pathlib.Path(__file__).parent.glob("_frahm.*.so"))
    if error.name != f"{__package__}._frahm" or not modules:
        return error
    tag = re.search(r"cpython-(\d)(\d+)", modules[0].name)
    built_for = f"Python {tag[1]}.{tag[2]}" if tag else "another Python"
    this = f"Python {sys.version_info.major}.{sys.version_info.minor} ({sys.executable})"
    command = f"python{tag[1]}.{tag[2]}" if tag else "that Python"
    return ImportError(
        f"frahm is built for {built_for} ({modules[0].name}), and this is {this}. Use {command}, or build frahm for this one: "
        f"cmake --preset release -DPython_EXECUTABLE={sys.executable} && cmake --build --preset release",
        name=error.name,
        path=str(modules[0]),
    )
