"""The files of runs as labelled arrays."""

import os
from typing import TYPE_CHECKING, Optional, Union

import numpy as np

if TYPE_CHECKING:
    import xarray


def open(path: Union[str, os.PathLike], group: Optional[str] = None) -> "xarray.Dataset":
    """Opens a result as an xarray dataset: its map, or one of its groups ("orbits", "optimum", "provenance").

    Data are read when they are used; `.load()` reads all, `.close()` closes the file.
    """
    import xarray

    return xarray.open_dataset(os.fspath(path), engine="h5netcdf", group=group)


def names(flags: "xarray.DataArray") -> "xarray.DataArray":
    """The words for the numbers of a flag of a result: names(ds.status) == "ok"."""
    if not hasattr(flags, "attrs"):
        raise TypeError(f"names: takes a variable of a dataset, such as ds.status, not {type(flags).__name__}")
    if "flag_meanings" not in flags.attrs:
        raise ValueError(f"{flags.name}: is no flag")
    meanings = flags.attrs["flag_meanings"].split()
    numbers = np.atleast_1d(flags.attrs["flag_values"])
    words = np.full(int(max(numbers)) + 1, "", dtype=f"<U{max(map(len, meanings))}")
    words[numbers] = meanings
    attributes = {key: value for key, value in flags.attrs.items() if not key.startswith("flag_")}
    return flags.copy(data=words[flags.values]).assign_attrs(attributes)
