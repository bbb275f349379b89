"""Identifies the damping law of the rig's inerter and reads the file as a user would.

usage: identify_arrays.py FRAHM SOURCE_DIR
"""

import os
import shutil
import subprocess
import sys
import tempfile

import h5py
import netCDF4
import numpy as np
import xarray as xr


def check(condition, what):
    if not condition:
        sys.exit(f"identify_arrays: {what}")


def identify(frahm, source, folder):
    shutil.copytree(os.path.join(source, "studies", "identification", "data"), os.path.join(folder, "data"))
    for name in ("identify_rig_tmd_mass", "identify_rig_tmd", "identify_rig_damping_law"):
        shutil.copy(os.path.join(source, "studies", "identification", name + ".toml"), folder)
        subprocess.run([frahm, "run", name + ".toml", "--progress", "none"], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL)
    return os.path.join(folder, "identify_rig_damping_law.h5")


def main():
    frahm, source = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        file = identify(frahm, source, folder)
        for engine in ("h5netcdf", "netcdf4"):
            with xr.open_dataset(file, engine=engine, group="identification") as found:
                names = found.attrs["estimates"].split()
                check("c_const" in names and "c_I" in names, f"{engine}: estimates {names}")
                check("m" in names and "d" in names, "what was fixed stands among the estimates")
                covariance = np.array([found[name + "_covariance"].values for name in names])
                correlation = np.array([found[name + "_correlation"].values for name in names])
                check(np.allclose(covariance, covariance.T, rtol=1e-12, atol=0), "covariance is symmetric")
                errors = np.array([float(found[name + "_standard_error"]) for name in names])
                check(np.allclose(np.sqrt(np.diag(covariance)), errors, rtol=1e-12), "standard errors")
                check(np.allclose(covariance / np.outer(errors, errors), correlation, rtol=1e-9), "correlations")
                for name in names:
                    low, value, high = (float(found[name + end]) for end in ("_low", "", "_high"))
                    check(low < value < high, f"{name}: {low} < {value} < {high}")
                    check(found[name].attrs["long_name"] != "", f"{name} has a long name")
                check(found["c_const"].attrs["units"] == "N s m-1", "unit of c_const")
                for k, record in enumerate(found.attrs["records"].split()):
                    y = found[f"{record}_tmd_displacement_measured"]
                    fit = found[f"{record}_tmd_displacement_fitted"]
                    check(y.dims == (f"{record}_time",), "a record runs over its own time")
                    left = found[f"{record}_tmd_displacement_residual"].values
                    check(np.array_equal(left, y.values - fit.values), "residual = measured - fitted")
                    quality = 100 * (1 - np.linalg.norm(left) / np.linalg.norm(y.values - y.values.mean()))
                    check(abs(quality - found["nrmse"].values[k]) < 1e-9, f"NRMSE of {record}")
        with h5py.File(file) as h5, netCDF4.Dataset(file) as nc:
            check(h5["identification/c_const"].shape == (), "an estimate is a number")
            check(len(nc["identification"].variables) == len(h5["identification"].keys()) -
                  sum(1 for name in nc["identification"].dimensions if name not in nc["identification"].variables),
                  "every dataset opens as a variable")


main()
