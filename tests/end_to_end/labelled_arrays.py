"""Runs the rig atlas on a small grid and reads its file as a user would: coordinates and units in place.

usage: labelled_arrays.py FRAHM SOURCE_DIR
"""

import os
import re
import subprocess
import sys
import tempfile

import h5py
import numpy as np
import xarray as xr

REDUCED = {"I": 42, "FP": 2, "omega": 81}


def reduced_study(source):
    with open(os.path.join(source, "studies", "rig", "rig_atlas.toml")) as file:
        text = file.read()
    for parameter, points in REDUCED.items():
        text, count = re.subn(rf'(parameter = "{parameter}"\n(?:unit.*\n)?from.*\nto.*\npoints = )\d+', rf"\g<1>{points}", text)
        assert count == 1, parameter
    assert text.count("\n[output]\n") == 1
    return text.replace("\n[output]\n", "\n[output]\norbits = [{ omega = 250, I = 6.36 }]\n")


def check_map(path, engine, study):
    with xr.open_dataset(path, engine=engine) as ds:
        assert dict(ds.sizes) == REDUCED, ds.sizes
        assert set(ds.coords) == {"I", "FP", "omega", "frequency_ratio", "inertance_ratio"}, ds.coords
        assert [ds[name].attrs["units"] for name in ("I", "FP", "omega")] == ["kg", "1", "rpm"]
        assert ds.main_peak.dims == ("I", "FP", "omega") and ds.main_peak.attrs["units"] == "m"
        assert ds.main_peak.attrs["long_name"] and ds.attrs["Conventions"] == "CF-1.10"
        assert ds.guide_regime.attrs["flag_meanings"].split()[2] == "non_stop"
        forced = ds.sel(omega=250, I=6.36, method="nearest")
        assert forced.main_peak.dims == ("FP",) and float(forced.omega) == 250.0
        assert abs(float(forced.I) - 6.36) < 0.1 and (0.001 < forced.main_peak).all()
        np.testing.assert_allclose(ds.frequency_ratio, ds.omega * np.pi / 30 / np.sqrt(7 * 8181.0 / 102.66), rtol=1e-14)
        assert (ds.status == 1).all() and float(ds.energy_balance.max()) < 1e-10
    with xr.open_dataset(path, engine=engine, group="provenance") as ds:
        assert ds.attrs["study"] == study and len(ds.attrs["fingerprint_physics"]) == 32
        assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", ds.attrs["started"])
        assert "HDF5 1." in ds.attrs["libraries"] and ds.attrs["threads"] == "2"
    with xr.open_dataset(path, engine=engine, group="orbits") as ds:
        assert dict(ds.sizes) == {"orbit": 1, "sample": 512}
        assert float(ds.omega[0]) == 250.0 and ds.omega.attrs["units"] == "rpm" and ds.time.attrs["units"] == "s"
        assert abs(float(ds.time[-1]) - 60 / 250) < 1e-12
        assert ds.guide_force.attrs["units"] == "N"
        np.testing.assert_array_equal(ds.guide_displacement, ds.main_displacement)
        np.testing.assert_array_equal(ds.guide_sliding_velocity, ds.main_velocity)
        np.testing.assert_allclose(ds.tmd_friction_displacement, ds.tmd_displacement - ds.main_displacement, atol=1e-15)
        assert ds.tmd_friction_sliding_velocity.attrs["units"] == "m s-1"
    with xr.open_dataset(path, engine=engine, group="modes") as ds:
        assert dict(ds.sizes) == {"mode": 2, "mode_mass": 2} and ds.attrs["masses"] == "main,tmd", ds
        assert ds.mode_frequency.attrs["units"] == "rpm" and list(ds.mode.values) == [1, 2]
        np.testing.assert_array_equal(abs(ds.mode_shape_1).max(), 1)
    with xr.open_dataset(path, engine=engine, group="borders") as ds:
        assert set(ds.data_vars) == {"I", "FP", "omega", "element", "axis", "regime_below", "regime_above"}
        assert ds.sizes["border"] > 0 and ds.omega.attrs["units"] == "rpm" and ds.I.attrs["units"] == "kg"
        assert ds.element.attrs["flag_meanings"] == "not_computed guide tmd_friction"
        assert ds.axis.attrs["flag_meanings"] == "not_computed I FP omega" and set(ds.axis.values) <= {1, 2, 3}
        assert ds.regime_below.attrs["flag_meanings"].split()[2:] == ["non_stop", "one_stop", "multi_stop", "stuck"]
        assert (ds.element == 2).all() and (ds.regime_below != ds.regime_above).all()
        for name, least, most in (("I", 4.72, 12.9), ("FP", 0, 0.3), ("omega", 150, 350)):
            assert ds[name].dtype == "f8" and (ds[name] >= least).all() and (ds[name] <= most).all()


def check_motions(program, source, folder, engine):
    """A map of motions and a history of one."""
    path = os.path.join(folder, "motions.h5")
    study = os.path.join(source, "studies", "structures", "shaken_frame.toml")
    subprocess.run([program, "run", study, "-o", path, "--threads", "2"], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    with xr.open_dataset(path, engine=engine) as ds:
        assert dict(ds.sizes) == {"F": 13, "omega": 11} and ds.F.attrs["units"] == "kN", ds
        assert ds.floor10_acceleration_peak.attrs["units"] == "m s-2" and ds.brace5_slips.dtype == "i4"
        assert ds.status.attrs["flag_meanings"] == "not_computed ok failed" and (ds.status == 1).all()
        assert float(ds.energy_balance.max()) < 1e-10 and not ds.floor10_residual.isnull().any()
        peak = float(ds.floor10_peak.sel(F=110, omega=6.5))
    with xr.open_dataset(path, engine=engine, group="histories") as ds:
        assert dict(ds.sizes) == {"history": 1, "sample": 1001} and float(ds.F[0]) == 110.0
        assert ds.time.attrs["units"] == "s" and float(ds.time[-1]) == 20.0
        largest = float(abs(ds.floor10_displacement).max())
        assert 0.98 * peak < largest <= peak, (peak, largest)


def main():
    program, source = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        path, study = os.path.join(folder, "rig.h5"), reduced_study(source)
        with open(os.path.join(folder, "rig.toml"), "w") as file:
            file.write(study)
        subprocess.run([program, "run", os.path.join(folder, "rig.toml"), "-o", path, "--threads", "2"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        check_map(path, "netcdf4", study)
        check_map(path, "h5netcdf", study)
        for engine in "netcdf4", "h5netcdf":
            check_motions(program, source, folder, engine)
        with h5py.File(path) as file:
            assert file["main_peak"].shape == tuple(REDUCED.values())
        subprocess.run(["h5dump", "-d", "/status", path], check=True, stdout=subprocess.DEVNULL)
    print("opened by xarray (netcdf4, h5netcdf), h5py and h5dump")


if __name__ == "__main__":
    main()
