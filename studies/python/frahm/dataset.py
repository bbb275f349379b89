"""The files of runs as labelled arrays."""

import os
from contextlib import contextmanager
from typing import TYPE_CHECKING, Iterator, Optional, Union

import numpy as np

from . import _frahm
from .assignments import file_name, plain

if TYPE_CHECKING:
    import xarray


def open(path: Union[str, os.PathLike], group: Optional[str] = None) -> "xarray.Dataset":
    """Opens a result as an xarray dataset: its map, or one of its groups.

    A map is opened without a group; next to it there may be "orbits", "resonance", "modes", "statistics" ... A result without
    a map is in a group: "optimum" of a tuning, for a trade-off with "optimum/front"; "identification"; "decay" or
    "transient" of one motion. Every result has "provenance". ValueError lists the groups of a file without the one requested,
    OSError (FileNotFoundError, IsADirectoryError) a file that is damaged or not a result.

    Data are read when they are used; `.load()` reads all, `.close()` closes the file.
    """
    import xarray

    name = file_name(path)
    if group is not None:
        plain(group, "group")
    _require_result(name)
    with _told_as_damage(name):
        known = _groups(name)
    if group is not None and group.strip("/") not in known:
        raise ValueError(f"{name}: has no group {group!r}; it has {', '.join(known)}")
    with _told_as_damage(name):
        dataset = xarray.open_dataset(name, engine="h5netcdf", group=group)
    if group is None and not dataset.variables:
        dataset.close()
        raise ValueError(f"{name}: has no map; name one of its groups: {', '.join(known)}")
    return dataset


def _require_result(name: str) -> None:
    """Refuses a file that is not a result, and a damaged one, with which HDF5 might end the interpreter."""
    if os.path.isdir(name):
        raise IsADirectoryError(f"{name}: is a folder; name a result in it")
    try:
        _frahm.check_result(name)
    except OSError as error:
        if not os.path.exists(name):
            raise FileNotFoundError(str(error)) from None
        raise


@contextmanager
def _told_as_damage(name: str) -> Iterator[None]:
    """Libraries may raise any error for a result whose names and references do not fit together."""
    try:
        yield
    except (ImportError, MemoryError):
        raise
    except Exception as error:
        raise OSError(f"{name}: is damaged: {error}") from error


def _groups(path: str) -> list[str]:
    import h5netcdf

    def within(group: "h5netcdf.Group", path: str) -> list[str]:
        return [each for name in group.groups for each in [path + name, *within(group[name], f"{path}{name}/")]]

    with h5netcdf.File(path, "r") as file:
        return within(file, "")


def names(flags: "xarray.DataArray") -> "xarray.DataArray":
    """The words for the numbers of a flag of a result: names(ds.status) == "ok"."""
    if not hasattr(flags, "attrs"):
        raise TypeError(f"names: takes a variable of a dataset, such as ds.status, not {type(flags).__name__}")
    if "flag_meanings" not in flags.attrs:
        raise ValueError(f"{flags.name}: is not a flag")
    meanings = flags.attrs["flag_meanings"].split()
    numbers = np.atleast_1d(flags.attrs["flag_values"])
    words = np.full(int(max(numbers)) + 1, "", dtype=f"<U{max(map(len, meanings))}")
    words[numbers] = meanings
    attributes = {key: value for key, value in flags.attrs.items() if not key.startswith("flag_")}
    return flags.copy(data=words[flags.values]).assign_attrs(attributes)
