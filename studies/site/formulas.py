"""Formulas as MathML, which browsers draw by themselves: no script, no fonts, no network. KaTeX (Debian's) makes it."""

import functools
import json
import subprocess

from docutils import nodes
from sphinx.errors import ExtensionError

katex = """
const katex = require('/usr/share/nodejs/katex');
require('readline').createInterface({ input: process.stdin }).on('line', (line) => {
  const { tex, display } = JSON.parse(line);
  let answer;
  try {
    answer = { mathml: katex.renderToString(tex, { output: 'mathml', displayMode: display, strict: 'error' }) };
  } catch (error) {
    answer = { error: error.message };
  }
  console.log(JSON.stringify(answer));
});
"""


@functools.cache
def converter():
    try:
        return subprocess.Popen(["node", "-e", katex], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    except FileNotFoundError as error:
        raise ExtensionError("formulas need Node.js and KaTeX (Debian: apt-get install nodejs katex)") from error


@functools.cache
def mathml(tex, display):
    process = converter()
    process.stdin.write(json.dumps({"tex": tex, "display": display}) + "\n")
    process.stdin.flush()
    line = process.stdout.readline()
    if not line:
        raise ExtensionError("KaTeX did not start (Debian: apt-get install katex)")
    answer = json.loads(line)
    if "error" in answer:
        raise ExtensionError(f"formula {tex!r}: {answer['error']}")
    return answer["mathml"]


def inline(translator, node):
    translator.body.append(mathml(node.astext(), False))
    raise nodes.SkipNode


def display(translator, node):
    translator.body.append(f'<div style="overflow-x: auto; overflow-y: hidden; padding: 0.4em 0">{mathml(node.astext(), True)}</div>\n')
    raise nodes.SkipNode


def stop(app, exception):
    if converter.cache_info().currsize:
        converter().stdin.close()
        converter().wait()


def setup(app):
    app.add_html_math_renderer("mathml", (inline, None), (display, None))
    app.connect("build-finished", stop)
    return {"parallel_read_safe": True, "parallel_write_safe": False}
