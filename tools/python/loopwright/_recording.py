"""Columns over time, and their way to and from files, pandas and xarray."""

import os as _os

from . import _core


class Recording:
    """Columns over time, of a run or a measurement. `recording[name]` is a read-only numpy array without a copy."""

    def __init__(self, columns):
        self._columns = columns

    @classmethod
    def from_columns(cls, columns, units=None):
        """From a dict of columns. The first is usually "time"; `units` gives the unit of each name, e.g. "mm"."""
        units = units or {}
        unknown = set(units) - set(columns)
        if unknown:
            raise ValueError(f"units without a column: {', '.join(sorted(unknown))}")
        return cls(_core.Columns(list(columns), [units.get(name, "") for name in columns], list(columns.values())))

    @classmethod
    def from_pandas(cls, frame):
        """From a DataFrame as `to_pandas` makes it: the index is the time, units are in `frame.attrs["units"]`."""
        columns = {frame.index.name or "time": frame.index.to_numpy(dtype=float)}
        columns.update({str(name): frame[name].to_numpy(dtype=float) for name in frame.columns})
        # The attrs of a frame outlive the selection and the removal of its columns.
        units = {name: unit for name, unit in frame.attrs.get("units", {}).items() if name in columns}
        return cls.from_columns(columns, units)

    @classmethod
    def from_xarray(cls, dataset):
        """From a Dataset as `to_xarray` makes it: one dimension, the unit of each variable in its attrs."""
        (dimension,) = dataset.dims
        variables = {dimension: dataset[dimension], **{str(n): dataset[n] for n in dataset.data_vars}}
        return cls.from_columns({n: v.to_numpy() for n, v in variables.items()},
                                {n: v.attrs["units"] for n, v in variables.items() if "units" in v.attrs})

    def __getitem__(self, name):
        return self._columns.column(name)

    def __contains__(self, name):
        return name in self._columns

    def __iter__(self):
        return iter(self._columns.names())

    def __len__(self):
        return len(self._columns)

    def keys(self):
        return self._columns.names()

    @property
    def time(self):
        return self["time"]

    @property
    def rows(self):
        return self._columns.rows

    @property
    def units(self):
        """{name: unit}; an empty text where the unit is not known."""
        return {name: self._columns.unit(name) for name in self}

    @property
    def facts(self):
        """{name: text}: title, hash of the plan, effective parameters."""
        return self._columns.facts()

    def save(self, path):
        """Writes .csv, .mat or .h5, with units and facts."""
        self._columns.save(_os.fspath(path))

    def to_pandas(self):
        """A DataFrame over time; units in `attrs["units"]`."""
        import pandas
        first, *others = self.keys()
        frame = pandas.DataFrame({name: self[name] for name in others},
                                 index=pandas.Index(self[first], name=first))
        frame.attrs["units"] = self.units
        return frame

    def to_xarray(self):
        """A Dataset over time; the unit of each variable in its attrs."""
        import xarray
        first, *others = self.keys()

        def attributes(name):
            unit = self._columns.unit(name)
            return {"units": unit} if unit else {}

        return xarray.Dataset({name: (first, self[name], attributes(name)) for name in others},
                              coords={first: (first, self[first], attributes(first))})

    def __repr__(self):
        return f"<loopwright.{type(self).__name__}: {self.rows} rows of {', '.join(self)}>"
