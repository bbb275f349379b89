"""Runs a study with branches and reads them as a user would, from the map's file and from that of one branch.

usage: branch_arrays.py FRAHM SOURCE_DIR
"""

import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np
import xarray as xr

FOLDS = [2.00180666851, 1.40867072840]


def check(path, engine):
    with xr.open_dataset(path, engine=engine, group="branches") as ds:
        assert ds.sizes["branch"] == 1 and ds.attrs["along"] == "r"
        assert ds.r.dims == ds.machine_peak.dims == ds.stability.dims == ("place",)
        kinds = dict(zip(ds.special.attrs["flag_meanings"].split(), ds.special.attrs["flag_values"]))
        np.testing.assert_allclose(ds.r[ds.special == kinds["fold"]], FOLDS, atol=1e-9)
        assert float(ds.special_residual.max()) < 1e-9
        unstable = ds.r[ds.stability == ds.stability.attrs["flag_meanings"].split().index("unstable")]
        assert FOLDS[1] < float(unstable.min()) and float(unstable.max()) < FOLDS[0] + 1e-9
        assert (np.diff(ds.arclength) > 0).all() and float(ds.residual.max()) < 1e-10
        assert ds.first_end.attrs["flag_meanings"].split()[int(ds.first_end[0])] == "range"


def main():
    program, source = sys.argv[1:]
    study = os.path.join(source, "studies", "stops", "machine_on_stops.toml")
    with tempfile.TemporaryDirectory() as folder:
        of_map, alone = os.path.join(folder, "map.h5"), os.path.join(folder, "branch.h5")
        for command in (["run", study, "-o", of_map], ["branch", study, "--along", "r", "-o", alone]):
            subprocess.run([program] + command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for path in (of_map, alone):
            check(path, "netcdf4")
            check(path, "h5netcdf")
            with h5py.File(path) as file:
                assert file["branches/row_start"][:].tolist() == [0]
            subprocess.run(["h5dump", "-d", "/branches/special", path], check=True, stdout=subprocess.DEVNULL)
    print("branches opened by xarray (netcdf4, h5netcdf), h5py and h5dump")


if __name__ == "__main__":
    main()
