"""Opens the sample file with every reader our users have and compares all of it with the formulas of sample.cpp.

usage: open_everywhere.py TEST_RESULTS_PROGRAM
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

DESIGNS, FREQUENCIES = 5, 70
REGIMES = "not_computed no_friction non_stop one_stop multi_stop stuck"


def expected():
    i, j = np.meshgrid(np.arange(DESIGNS), np.arange(FREQUENCIES), indexing="ij")
    missing = (i == 4) & (j >= 48) & (j < 64)
    return {
        "main_peak": np.where(missing, np.nan, (i + 1.0) / (j + 1.0)),
        "main_phase": np.where(missing, np.nan, (i - j) / 8.0).astype("f4"),
        "guide_stops": np.where(missing, -1, i * j % 7).astype("i4"),
        "guide_regime": np.where(missing, 0, (i + j) % 5 + 1).astype("i1"),
        "status": np.where(missing, 0, 1).astype("i1"),
    }


UNITS = {"main_peak": "m", "main_phase": "rad", "guide_stops": "1"}


def same(name, found, wanted):
    found = np.asarray(found)
    assert found.dtype == wanted.dtype, f"{name}: dtype {found.dtype}, not {wanted.dtype}"
    np.testing.assert_array_equal(found, wanted, err_msg=name)


def check_text(text):
    assert text.startswith('[study]\ntitle = "ζ and ω"\n') and len(text.encode()) >= 200_000


def check_xarray(path, engine):
    with xr.open_dataset(path, engine=engine) as d:
        assert dict(d.sizes) == {"design": DESIGNS, "omega": FREQUENCIES}, d.sizes
        assert set(d.coords) == {"design", "omega", "k", "c", "frequency_ratio"}, d.coords
        assert list(d.data_vars) == list(expected()), d.data_vars
        for name, wanted in expected().items():
            assert d[name].dims == ("design", "omega"), (name, d[name].dims)
            same(name, d[name].values, wanted)
            assert d[name].attrs.get("units") == UNITS.get(name), name
            assert d[name].attrs["long_name"], name
        same("omega", d["omega"].values, 150.0 + 2.0 * np.arange(FREQUENCIES))
        same("frequency_ratio", d["frequency_ratio"].values, (150.0 + 2.0 * np.arange(FREQUENCIES)) / 200.0)
        same("k", d["k"].values, 1000.0 + np.arange(DESIGNS))
        assert d["k"].dims == ("design",) and d["frequency_ratio"].dims == ("omega",)
        same("design", d["design"].values, np.arange(DESIGNS))
        assert d["omega"].attrs["units"] == "rpm" and d["k"].attrs["units"] == "N m-1"
        assert d["frequency_ratio"].attrs["long_name"] == "ω/ω_n"
        assert d["guide_regime"].attrs["flag_meanings"] == REGIMES
        same("flag_values", d["guide_regime"].attrs["flag_values"], np.arange(6, dtype="i1"))
        assert d.attrs["Conventions"] == "CF-1.10" and d.attrs["title"] == "Sample"
        assert int(d.attrs["format_version"]) == 1 and d.attrs["format"] == "frahm"
        assert float(d["main_peak"].sel(omega=151.1, method="nearest")[3]) == 4.0 / 2.0
    with xr.open_dataset(path, engine=engine, group="provenance") as d:
        check_text(d.attrs["study"])
        assert d.attrs["note"] == "Dämpfung ζ" and d.attrs["version"] == "0.1.0"
    with xr.open_dataset(path, engine=engine, group="orbits") as d:
        assert dict(d.sizes) == {"orbit": 3, "sample": 9000}, d.sizes
        same("row_start", d["row_start"].values, np.array([0, 0, 3000]))
        s = np.concatenate([np.arange(3000.0), np.arange(6000.0)])
        same("main_displacement", d["main_displacement"].values, s / 1024)
        same("time", d["time"].values, 1e-3 * s)
        same("omega", d["omega"].values, np.array([100.0, 101.0, 102.0]))
    with xr.open_dataset(path, engine=engine, group="borders") as d:
        same("omega", d["omega"].values, np.array([160.5, 161.5, 162.5]))
        assert d["omega"].attrs["units"] == "rpm" and d["omega"].dims == ("border",)
    with xr.open_dataset(path, engine=engine, group="no_borders") as d:
        assert dict(d.sizes) == {"border": 0}
    with xr.open_dataset(path, engine=engine, group="optimum") as d:
        assert float(d["objective"]) == 0.0125 and d["objective"].shape == ()
        assert int(d["iterations"]) == 17 and d["iterations"].dtype == np.int32
        same("inertance", d["inertance"].values, np.array([4.72, np.nan, 12.9]))
        assert d["inertance"].dims == ("knot",) and list(d["knot"].values) == [15.0, 25.0, 35.0]
        assert d.sizes["peak"] == 0
    with xr.open_dataset(path, engine=engine, group="page") as d:
        assert d.attrs["parameters"] == "k,c" and not d.variables
    with xr.open_dataset(path, engine=engine, group="page/crank") as d:
        same("angle", d["angle"].values, np.array([0.0, 1.0]))


def check_h5py(path):
    with h5py.File(path, "r") as f:
        for name, wanted in expected().items():
            d = f[name]
            same(name, d[()], wanted)
            assert d.shuffle and d.compression == "gzip" and d.compression_opts == 1 and d.fletcher32, name
            assert [axis[0].name for axis in d.dims] == ["/design", "/omega"], name
            fill = {"f": np.nan, "i": -1 if wanted.dtype.itemsize > 1 else 0}[wanted.dtype.kind]
            np.testing.assert_array_equal(d.fillvalue, fill)
            assert ("_FillValue" in d.attrs) == (wanted.dtype.kind == "f"), name
        assert np.isnan(f["main_peak"].attrs["_FillValue"]).all() and f["main_peak"].attrs["_FillValue"].shape == (1,)
        check_text(f["provenance"].attrs["study"].decode())
        assert f["provenance"].attrs["empty"] in (b"", np.bytes_(b"")), f["provenance"].attrs["empty"]


def check_netcdf4(path):
    with netCDF4.Dataset(path) as d:
        assert d.data_model == "NETCDF4" and list(d.dimensions) == ["design", "omega"], d.dimensions
        assert d["main_peak"].dimensions == ("design", "omega") and d["main_peak"].units == "m"
        assert np.ma.count_masked(d["main_peak"][:]) == 16
        assert not d.dimensions["omega"].isunlimited()
        check_text(d["provenance"].study)


def check_tools(path):
    h5dump = shutil.which("h5dump")
    assert h5dump, "h5dump (package hdf5-tools) is not installed"
    text = subprocess.run([h5dump, path], check=True, capture_output=True, text=True).stdout
    for word in ('DATASET "main_peak"', 'GROUP "orbits"', 'ATTRIBUTE "flag_meanings"'):
        assert word in text, word
    part = subprocess.run([h5dump, "-d", "/guide_stops", "-s", "2,1", "-c", "1,3", "-y", path], check=True,
                          capture_output=True, text=True).stdout
    assert "2, 4, 6" in part, part
    if ncdump := shutil.which("ncdump"):
        header = subprocess.run([ncdump, "-h", path], check=True, capture_output=True, text=True).stdout
        assert "double main_peak(design, omega)" in header, header


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as directory:
        path = os.path.join(directory, "sample.h5")
        subprocess.run([program, "[.sample]"], check=True, env={**os.environ, "FRAHM_SAMPLE_FILE": path},
                       stdout=subprocess.DEVNULL)
        checks = [lambda: check_xarray(path, "netcdf4"), lambda: check_xarray(path, "h5netcdf"),
                  lambda: check_h5py(path), lambda: check_netcdf4(path), lambda: check_tools(path)]
        for check in checks:
            check()
    print("opened by xarray (netcdf4, h5netcdf), h5py, netCDF4 and h5dump")


if __name__ == "__main__":
    main()
