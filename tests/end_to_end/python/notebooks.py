"""notebooks.py NOTEBOOK: runs a notebook from its beginning, as a reader would; any error in it fails."""

import os
import sys
from pathlib import Path

os.environ.pop("MPLBACKEND", None)  # figures in line, as a notebook has them
os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"
os.environ.setdefault("FRAHM_STUDIES", str(Path(os.environ["FRAHM_SOURCE_DIR"]) / "studies"))

import nbclient  # noqa: E402
import nbformat  # noqa: E402

notebook = nbformat.read(sys.argv[1], as_version=4)
assert not any(cell.get("outputs") for cell in notebook.cells), "notebooks are kept without outputs"
# A kernel of this very Python, whatever kernels are registered here.
client = nbclient.NotebookClient(notebook, timeout=240, kernel_name="python3")
client.create_kernel_manager()
client.km.kernel_spec.argv = [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"]
client.execute()

outputs = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
pictures = [output for output in outputs if "image/png" in output.get("data", {})]
assert pictures, "no figure was drawn"
texts = "".join(output.get("text", "") for output in outputs)
assert not [output for output in outputs if output.get("name") == "stderr"], "a notebook shows errors in red"
if Path(sys.argv[1]).stem == "atlas":
    assert "\r[" in texts and "100.0 %" in texts, "the progress of a run is shown"
print(f"{len(outputs)} outputs, {len(pictures)} figures")
