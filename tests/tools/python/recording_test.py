"""Recordings to and from files, pandas and xarray."""
import loopwright as lw
import numpy as np
import pytest


@pytest.fixture
def recording():
    time = np.arange(5) * 0.1
    return lw.Recording.from_columns({"time": time, "axis.position": time**2, "plain": -time},
                                     {"time": "s", "axis.position": "mm"})


def same(a, b):
    return list(a) == list(b) and a.units == b.units and all(np.array_equal(a[n], b[n]) for n in a)


@pytest.mark.parametrize("name", ["a.csv", "a.mat"])
def test_files_keep_numbers_and_units(recording, tmp_path, name):
    recording.save(tmp_path / name)
    again = lw.read(tmp_path / name)
    assert sorted(again) == sorted(recording) and again.units["axis.position"] in ("mm", "m")
    assert np.array_equal(again["plain"], recording["plain"])


def test_pandas_round_trip_with_units(recording):
    pytest.importorskip("pandas")
    frame = recording.to_pandas()
    assert frame.index.name == "time" and frame.attrs["units"]["axis.position"] == "mm"
    assert same(lw.Recording.from_pandas(frame), recording)


def test_a_selection_of_pandas_columns_leaves_the_other_units_behind(recording):
    pytest.importorskip("pandas")
    frame = recording.to_pandas()
    some = lw.Recording.from_pandas(frame[["plain"]])
    assert list(some) == ["time", "plain"] and some.units == {"time": "s", "plain": ""}
    kept = lw.Recording.from_pandas(frame.drop(columns="plain"))
    assert kept.units == {"time": "s", "axis.position": "mm"}


def test_a_recording_keeps_the_units_of_its_file(tmp_path):
    (tmp_path / "foreign.csv").write_text("t [ms],x [mm]\n0,1\n1,2\n2,4\n")
    read = lw.read(tmp_path / "foreign.csv")
    assert read.units == {"t": "ms", "x": "mm"} and list(read["x"]) == [1, 2, 4]


def test_xarray_round_trip_with_units(recording):
    pytest.importorskip("xarray")
    dataset = recording.to_xarray()
    assert dataset["axis.position"].attrs["units"] == "mm" and "units" not in dataset["plain"].attrs
    assert same(lw.Recording.from_xarray(dataset), recording)


def test_a_run_as_pandas(common_job):
    pytest.importorskip("pandas")
    result = lw.load(common_job).run()
    frame = result.to_pandas()
    assert frame["stage.position"].iloc[-1] == result["stage.position"][-1]
    assert frame.attrs["units"] == result.units


def test_what_is_no_recording_is_refused():
    with pytest.raises(ValueError):
        lw.Recording.from_columns({"time": [0, 1], "a": [1]})
    with pytest.raises(ValueError, match="without a column"):
        lw.Recording.from_columns({"time": [0, 1]}, {"tiem": "s"})
    with pytest.raises(ValueError, match="dimension"):
        lw.Recording.from_columns({"time": [[0, 1]]})


def test_a_missing_file_names_itself(tmp_path):
    with pytest.raises(lw.InputError, match="none.csv"):
        lw.read(tmp_path / "none.csv")
