"""Runs a map of samples and reads its statistics and its tornado as a user would, beside those of xarray and numpy.

usage: sample_arrays.py FRAHM SOURCE_DIR
"""

import os
import subprocess
import sys
import tempfile

import numpy as np
import xarray as xr


def check(path, engine):
    with xr.open_dataset(path, engine=engine) as root, \
            xr.open_dataset(path, engine=engine, group="statistics") as statistics, \
            xr.open_dataset(path, engine=engine, group="tornado") as tornado:
        assert dict(root.sizes) == {"draw": 1000, "r": 121} and set(root.coords) == {"draw", "r", "nu", "zeta"}
        peaks = root.machine_peak
        assert statistics.machine_peak_mean.dims == tornado.machine_peak_at_mean.dims == ("r",)
        np.testing.assert_array_equal(statistics.r, root.r)
        np.testing.assert_allclose(statistics.machine_peak_mean, peaks.mean("draw"), rtol=1e-13)
        np.testing.assert_allclose(statistics.machine_peak_deviation, peaks.std("draw", ddof=1), rtol=1e-12)
        for share, name in ((0.05, "q5"), (0.5, "q50"), (0.95, "q95")):
            quantile = statistics["machine_peak_" + name]
            np.testing.assert_allclose(quantile, np.quantile(peaks, share, axis=0), rtol=1e-14)
            low, high = statistics[f"machine_peak_{name}_low"], statistics[f"machine_peak_{name}_high"]
            assert (low < quantile).all() and (quantile < high).all()
            assert quantile.attrs["units"] == "1" and "quantile of largest displacement" in quantile.attrs["long_name"]
        assert (statistics.machine_peak_samples == 1000).all()
        np.testing.assert_allclose(tornado.machine_peak_share_nu + tornado.machine_peak_share_zeta, 1, rtol=1e-12)


def main():
    frahm, source = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scatter.h5")
        study = os.path.join(source, "studies", "uncertainty", "absorber_scatter.toml")
        subprocess.run([frahm, "run", study, "-o", path, "--threads", "2"], check=True, stdout=subprocess.DEVNULL)
        for engine in ("h5netcdf", "netcdf4"):
            check(path, engine)


if __name__ == "__main__":
    main()
