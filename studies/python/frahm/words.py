"""The messages of the program in the words of this package: an option by its argument, a command by its call."""

import re

_WORDS = [(re.compile(pattern), words) for pattern, words in (
    (r"another (for the result )?with -o\b", r"another output \1"),
    (r"another file with -o\b", "another output"),
    (r"(?<!\S)-o\b", "output"),
    (r"--fresh\b", "fresh=True"),
    (r"--from\b", "from_result"),
    (r'--set "([^"]*)":', r"\1:"),
    (r"--set\b", "with_parameters()"),
    (r"frahm run (?=completes|computes)", "run() "),
    (r"use frahm run$", "use run()"),
    (r"the same command\b", "the same call"),
    (r"name its result, such as (.*), which frahm run .* makes", r"frahm.Study.load reads it, and its run() makes a result, such as \1"),
    (r"\(frahm status, report and export take results\)", "(frahm.open opens results)"),
)]

_POINT = re.compile(r'( *)frahm point .* --at "([^"]*)".*')


def of_python(message: str) -> str:
    """A message of the program in the words of Python."""
    for pattern, words in _WORDS:
        message = pattern.sub(words, message)
    return _POINT.sub(lambda found: f"{found[1]}study.point({_keywords(found[2])})", message)


def _keywords(assignments: str) -> str:
    """omega=250 rpm,I=6 -> omega="250 rpm", I=6"""
    pairs = (each.partition("=") for each in assignments.split(","))
    return ", ".join(f'{name}="{value}"' if " " in value else f"{name}={value}" for name, _, value in pairs)
