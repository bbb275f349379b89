"""Runs a decay and a transient and reads their files as a user would.

usage: motion_arrays.py FRAHM SOURCE_DIR
"""

import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np
import xarray as xr


def check_energies(ds, elements):
    lost = sum(float(ds[e + "_energy"]) for e in elements)
    assert {name for name in ds if name.endswith("_dissipated")} == {e + "_dissipated" for e in elements}
    for e in elements:
        assert ds[e + "_energy"].attrs["units"] == "J" and ds[e + "_energy_share"].attrs["units"] == "1"
        assert abs(float(ds[e + "_energy_share"]) - float(ds[e + "_energy"]) / lost) < 1e-14
        assert ds[e + "_dissipated"].dims == ("time",) and float(ds[e + "_dissipated"][0]) == 0.0
        assert abs(float(ds[e + "_dissipated"][-1]) - float(ds[e + "_energy"])) < 1e-12 * lost
    given = float(ds.initial_energy) + (float(ds.energy_input) if "energy_input" in ds else 0.0)
    assert abs(given - lost - float(ds.final_energy)) < 1e-12 * given and float(ds.energy_balance) < 1e-12


def check_decay(path, engine):
    with xr.open_dataset(path, engine=engine) as ds:
        assert not ds.sizes and not ds.variables and ds.attrs["Conventions"] == "CF-1.10"
    with xr.open_dataset(path, engine=engine, group="decay") as ds:
        assert dict(ds.sizes) == {"extremum": 82, "time": 2001}, ds.sizes
        assert ds.main_extremum.dims == ("extremum",) and ds.main_extremum.attrs["units"] == "m"
        assert ds.main_extremum_time.attrs["units"] == "s" and ds.stop_time.dims == ()
        assert abs(float(ds.stop_time) - 10.774157851747) < 1e-11
        assert float(ds.main_extremum[0]) == 0.03 and np.isnan(ds.main_log_decrement[-1])
        assert ds.main_displacement.dims == ("time",) and float(ds.time[-1]) == float(ds.stop_time)
        check_energies(ds, ["guide_damper", "guide"])
        assert "energy_input" not in ds
    with xr.open_dataset(path, engine=engine, group="provenance") as ds:
        assert 'kind   = "decay"' in ds.attrs["study"] and len(ds.attrs["fingerprint_physics"]) == 32


def check_transient(path, engine):
    with xr.open_dataset(path, engine=engine, group="transient") as ds:
        assert dict(ds.sizes)["time"] == 30001 and "stop" in ds.sizes, ds.sizes
        assert ds.main_velocity.attrs["units"] == "m s-1" and float(ds.guide_stop_onset[0]) == 0.0
        assert ds.guide_release.dims == ("stop",) and float(ds.time[-1]) == 60.0
        assert float(ds.main_peak) >= float(abs(ds.main_displacement).max())
        check_energies(ds, ["guide_damper", "guide", "tmd_damper", "tmd_friction"])
        assert ds.energy_input.attrs["units"] == "J"


def main():
    program, source = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        for study, check, group in (("rig_decay_main", check_decay, "decay"), ("rig_forced_250rpm_I6", check_transient, "transient")):
            path = os.path.join(folder, study + ".h5")
            subprocess.run([program, "run", os.path.join(source, "studies", "rig", study + ".toml"), "-o", path], check=True,
                           stdout=subprocess.DEVNULL)
            check(path, "netcdf4")
            check(path, "h5netcdf")
            with h5py.File(path) as file:
                assert file[group]["time"].shape[0] > 2000
            subprocess.run(["h5dump", "-H", path], check=True, stdout=subprocess.DEVNULL)
    print("opened by xarray (netcdf4, h5netcdf), h5py and h5dump")


if __name__ == "__main__":
    main()
