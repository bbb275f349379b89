"""Runs a tuning with a schedule, scenarios and a trade-off and reads its file as a user would.

usage: tuning_arrays.py FRAHM SOURCE_DIR
"""

import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np
import xarray as xr

STUDY = """
[study]
schema = 1
kind = "tune"
units = "dimensionless"
[parameters]
r = 1
f = 0.9
zeta = 0.2
P = 1
[[mass]]
name = "main"
mass = 1
[[mass]]
name = "tmd"
mass = 0.05
[[element]]
name = "spring"
type = "spring"
between = ["ground", "main"]
stiffness = 1
[[element]]
name = "tmd_spring"
type = "spring"
between = ["main", "tmd"]
stiffness = "0.05*f^2"
[[element]]
name = "tmd_damper"
type = "damper"
between = ["main", "tmd"]
damping = "0.1*zeta*f"
[excitation]
frequency = "r"
[[excitation.force]]
on = "main"
amplitude = "P"
[tune]
objective = "minimax"
quantity = "main_peak"
band = { parameter = "r", from = 0.7, to = 1.3 }
start = 2
trade_off = { quantity = "tmd_spring_stroke", values = [40, 30] }
[[design]]
parameter = "f"
lower = 0.8
upper = 1.1
schedule = { knots = 3, max_slope = 2 }
rule = "r"
[[design]]
parameter = "zeta"
lower = 0.05
upper = 0.5
[[scenario]]
name = "soft"
set = { P = 1 }
[[scenario]]
name = "hard"
set = { P = 1.2 }
[[column]]
name = "gear"
value = "f/r"
upper = 1.2
"""


def check_optimum(path, engine):
    with xr.open_dataset(path, engine=engine) as ds:
        assert not ds.sizes and not ds.variables and ds.attrs["Conventions"] == "CF-1.10"
    with xr.open_dataset(path, engine=engine, group="optimum") as ds:
        assert ds.sizes["knots_f"] == 3 and ds.sizes["start"] == 2 and ds.sizes["change"] == 6, ds.sizes
        assert ds.objective.dims == () and ds.f.dims == ("knots_f",) and ds.zeta.dims == ()
        assert ds.response_after_hard.dims == ("r",) and ds.r.attrs["units"] == "1"
        assert float(ds.r[0]) == 0.7 and float(ds.r[-1]) == 1.3 and (np.diff(ds.r) > 0).all()
        assert ds.outcome.attrs["flag_meanings"].split()[1] == "converged"
        assert ds.gear_range.dims == ("r",) and ds.f_schedule.dims == ("r",)
        assert ds.attrs["scenarios"] == "soft,hard" and ds.attrs["reason"]
        np.testing.assert_allclose(ds.response_after_hard, 1.2 * ds.response_after_soft, rtol=1e-9)
        near = ds.sel(r=1.0, method="nearest")
        assert near.f_schedule.dims == () and 0.8 <= float(near.f_schedule) <= 1.1
    with xr.open_dataset(path, engine=engine, group="optimum/front") as ds:
        assert dict(ds.sizes) == {"trade_off": 2} and list(ds.trade_off) == [40, 30]
        assert {"objective", "outcome", "f_0", "f_2", "zeta"} <= set(ds.variables)
    with xr.open_dataset(path, engine=engine, group="provenance") as ds:
        assert 'kind = "tune"' in ds.attrs["study"] and len(ds.attrs["fingerprint_physics"]) == 32


def main():
    program, _ = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        study, path = os.path.join(folder, "tmd.toml"), os.path.join(folder, "tmd.h5")
        with open(study, "w") as file:
            file.write(STUDY)
        code = subprocess.run([program, "run", study, "-o", path], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode
        assert code in (0, 7), code  # 7: a front may end where no design meets its limit
        check_optimum(path, "netcdf4")
        check_optimum(path, "h5netcdf")
        with h5py.File(path) as file:
            assert file["optimum"]["f"].shape == (3,) and file["optimum/front/objective"].shape == (2,)
        subprocess.run(["h5dump", "-d", "/optimum/objective", path], check=True, stdout=subprocess.DEVNULL)
    print("opened by xarray (netcdf4, h5netcdf), h5py and h5dump")


if __name__ == "__main__":
    main()
