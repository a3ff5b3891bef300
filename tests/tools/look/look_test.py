"""Recordings from elsewhere, written by SciPy, h5py and plain Python, and what the program makes of them.

    /usr/bin/python3 tests/tools/look/look_test.py build/release/bin/loopwright
"""
import csv
import json
import os
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy as np
import scipy.io

program = os.path.abspath(sys.argv[1])


class InFolder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def write(self, name, text, encoding="utf-8"):
        with open(self.path(name), "w", newline="", encoding=encoding) as file:
            file.write(text if isinstance(text, str) else json.dumps(text))
        return self.path(name)

    def run_program(self, *arguments, code=0):
        done = subprocess.run([program, *arguments], capture_output=True, encoding="utf-8", cwd=self.folder.name)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def look(self, name, *arguments):
        return json.loads(self.run_program("look", self.path(name), "--json", "-", *arguments).stdout)

    def refused(self, name):
        return self.run_program("look", self.path(name), code=2).stderr

    def played(self, name, column, **settings):
        """The column as the diagram plays it back, at the given times."""
        diagram = {"loopwright": 1, "solver": {"stop": 0.004, "record_step": 0.001}, "log": ["c.value"],
                   "blocks": {"c": {"type": "RecordedColumn", "file": name, "column": column, **settings}}}
        self.write("play.json", diagram)
        out = self.run_program("run", "play.json", "-o", "-", "-q").stdout
        return [float(line.split(",")[1]) for line in out.splitlines() if line[0] in "-0123456789"]


def finding_names(look):
    return [finding["name"] for finding in look["findings"]]


def column(look, name):
    return next(c for c in look["columns"] if c["name"] == name)


class Look(InFolder):
    rng = np.random.default_rng(3)

    def table(self, name, heading, *columns, form="%.9g"):
        rows = "\n".join(",".join(form % v for v in row) for row in zip(*columns))
        return self.write(name, heading + "\n" + rows + "\n")

    def test_time_gaps_rates_resolution_noise(self):
        time = np.delete(np.arange(4000) * 1e-3, [500, 501, 2000])
        position = np.round(20 * np.sin(2 * np.pi * time) / 0.005) * 0.005
        position[1500] += 4
        force = 0.3 * np.sin(2 * np.pi * time) + 0.01 * self.rng.standard_normal(len(time))
        slow = np.repeat(np.sin(np.arange(1000)), 4)[: len(time)]
        self.table("a.csv", "t [s],x [mm],force [N],slow [V],dead [A]", time, position, force, slow, 0 * time)
        look = self.look("a.csv")
        self.assertEqual(look["rows"], 3997)
        self.assertEqual(look["time"]["sample_time_s"], 0.001)
        self.assertEqual([(round(g["behind_s"], 9), g["samples"]) for g in look["time"]["gaps"]], [(0.499, 2), (1.999, 1)])
        self.assertEqual(look["time"]["missing_samples"], 3)
        self.assertTrue(look["time"]["even"])
        self.assertAlmostEqual(column(look, "x")["resolution"], 0.005, places=9)
        self.assertEqual(column(look, "x")["outlier_rows"], [1500])
        self.assertEqual(column(look, "force")["resolution"], 0)
        self.assertAlmostEqual(column(look, "force")["noise"], 0.01, delta=0.001)
        self.assertEqual(column(look, "slow")["rows_between_changes"], 4)
        self.assertEqual(finding_names(look), ["gaps", "outliers", "slower", "constant"])

    def test_repeats_of_a_motion(self):
        time = np.arange(6000) * 1e-3
        self.table("a.csv", "t [s],x [m]", time, np.abs((time % 1.5) - 0.75) ** 2)
        self.assertAlmostEqual(column(self.look("a.csv"), "x")["repeats_after_s"], 1.5, delta=0.002)

    def test_jitter_and_rounded_stamps(self):
        late = np.arange(2000) * 1e-3 + 1e-4 * self.rng.standard_normal(2000)
        self.table("jitter.csv", "t [s],x [m]", np.sort(late), np.sin(late))
        look = self.look("jitter.csv")
        self.assertAlmostEqual(look["time"]["jitter_s"], 1e-4, delta=1e-5)
        self.assertIn("uneven", finding_names(look))
        rounded = np.round(np.arange(20000) / 1500, 4)
        self.table("rounded.csv", "t [s],x [m]", rounded, np.sin(rounded))
        look = self.look("rounded.csv")
        self.assertAlmostEqual(look["time"]["sample_time_s"], 1 / 1500, places=12)
        self.assertEqual(look["time"]["written_to_s"], 1e-4)
        self.assertIn("rounded_stamps", finding_names(look))
        # What a diagram plays is held from the instant of the sample on, not from its stamp.
        even = [k / 300 for k in range(100)]
        self.table("played.csv", "t [s],x [1]", np.round(even, 3), np.arange(100.0))
        self.assertIn("rounded_stamps", finding_names(self.look("played.csv")))
        played = self.played("played.csv", "x", interpolation="linear")
        np.testing.assert_allclose(played, [0, 0.3, 0.6, 0.9, 1.2], rtol=0, atol=1e-12)

        few = even[:30]
        self.table("few.csv", "t [s],x [1]", np.round(few, 3), np.arange(30.0))
        advice = [f["advice"] for f in self.look("few.csv")["findings"] if f["name"] == "rounded_stamps"]
        self.assertEqual([text.split(":")[0] for text in advice], ["compared and driven at the stamps"])

    def test_units_that_are_written_wrongly_get_a_hint(self):
        self.write("u.csv", "t [s],torque [Nm],speed [RPM],slip [-]\n0,1,2,3\n1,2,3,4\n2,3,4,6\n")
        look = self.look("u.csv")
        advice = {f["text"].split('"')[1]: f["advice"] for f in look["findings"] if f["name"] == "unit_not_known"}
        self.assertEqual(set(advice), {"Nm", "RPM"})
        self.assertIn('did you mean "N*m"?', advice["Nm"])
        self.assertIn('did you mean "rpm"?', advice["RPM"])
        self.assertEqual(column(look, "slip")["unit"], "1")

    def test_questions_about_the_time(self):
        self.table("ms.csv", "t,x [mm]", np.arange(200), np.arange(200) ** 2)
        self.assertIn("time_without_unit", finding_names(self.look("ms.csv")))
        self.table("ms2.csv", "t [ms],x [mm]", np.arange(200), np.arange(200) ** 2)
        look = self.look("ms2.csv")
        self.assertEqual((look["time"]["sample_time_s"], look["findings"]), (0.001, []))
        self.table("unnamed.csv", "a [V],b [V]", np.arange(200) * 1e-3, np.arange(200) ** 2)
        self.assertEqual(self.run_program("look", "unnamed.csv").returncode, 0)  # in words, too
        look = self.look("unnamed.csv")
        self.assertIn("time_not_usable", finding_names(look))  # a voltage is no time
        self.assertIsNone(look["time"])
        self.table("back.csv", "t,x [m]", np.concatenate([np.arange(100), np.arange(100)]) * 1e-3, np.arange(200))
        look = self.look("back.csv")
        self.assertEqual(finding_names(look)[0], "time_goes_back")
        self.assertIn("row 101", look["findings"][0]["text"])
        twice = np.repeat(np.arange(100) * 1e-3, 2)
        self.table("again.csv", "t,x [m]", twice, twice**2)
        self.assertIn("100 of them with the same numbers", self.look("again.csv")["findings"][0]["text"])

    def test_times_and_units_that_contradict(self):
        self.table("a.csv", "time,t,x [furlong/s2s]", *[np.arange(5)] * 3)
        names = finding_names(self.look("a.csv"))
        self.assertIn("time_not_usable", names)
        self.assertIn("unit_not_known", names)
        self.assertNotIn("time_not_usable", finding_names(self.look("a.csv", "--time", "t")))
        self.assertIn("no column", self.run_program("look", self.path("a.csv"), "--time", "u", code=2).stderr)

    def test_holes_are_counted_and_tables_on_their_side_questioned(self):
        self.write("a.csv", "t,x [m],y [m]\n0,1,1\n0.1,nan,2\n0.2,3,3\n")
        self.assertIn("not_finite", finding_names(self.look("a.csv")))
        self.write("c.csv", "t [s];x [m];note;\n0;1;start;\n0.1;;;\n0.2;3;;\n")
        look = self.look("c.csv")
        self.assertEqual([c["name"] for c in look["columns"]], ["x", "note"])
        self.assertEqual([c["not_finite"] for c in look["columns"]], [1, 3])
        self.assertRegex(column(look, "x")["first_hole"], "^an empty cell in .*c.csv:3:5$")
        self.assertRegex(column(look, "note")["first_hole"], r"^text where a number should be \(start\) in .*c.csv:2:5$")
        self.assertEqual((column(look, "x")["least"], column(look, "x")["greatest"]), (1, 3))
        self.assertEqual(finding_names(look), ["not_finite", "not_finite"])
        self.write("d.csv", "t [s];x [m]\n0;1\n;2\n0.2;3\n")
        look = self.look("d.csv")
        self.assertIsNone(look["time"])
        self.assertIn("d.csv:3:1", next(f["text"] for f in look["findings"] if f["name"] == "time_not_usable"))
        self.write("b.csv", "0,0.1,0.2,0.3\n1,2,3,4\n")
        self.assertIn("on_its_side", finding_names(self.look("b.csv")))

    def test_the_page(self):
        self.write("a.csv", "t [s],x [m]\n" + "".join(f"{i / 1000},{i * i % 17}\n" for i in range(300)))
        self.run_program("look", "a.csv", "--report", "page.html")
        with open(self.path("page.html"), encoding="utf-8") as page:
            text = page.read()
        for word in ("a.csv", "From row to row", "Resolution"):
            self.assertIn(word, text)


class Matlab(InFolder):
    time = np.arange(5) * 1e-3

    def scope(self, *signals, time=None):
        kinds = [("values", "O"), ("dimensions", "O"), ("label", "O"), ("title", "O"), ("plotStyle", "O")]
        array = np.empty((1, len(signals)), dtype=kinds)
        for i, (label, values) in enumerate(signals):
            array[0, i] = (values, float(values.shape[1]) if values.ndim == 2 else 1.0, label, "", np.zeros((1, 2)))
        return {"time": self.time[:, None] if time is None else time, "signals": array, "blockName": "model/Scope"}

    def save(self, **variables):
        scipy.io.savemat(self.path("a.mat"), variables)
        return self.path("a.mat")

    def test_structure_with_time(self):
        speed, currents = np.arange(5.0)[:, None] ** 2, np.arange(10.0).reshape(5, 2)
        self.save(log=self.scope(("speed", speed), ("", currents)))
        look = self.look("a.mat")
        self.assertEqual(look["time"]["column"], "log.time")
        self.assertEqual([c["name"] for c in look["columns"]], ["log.speed", "log.signals[1][0]", "log.signals[1][1]"])
        self.assertEqual(self.played("a.mat", "log.speed"), [0, 1, 4, 9, 16])
        self.assertEqual(self.played("a.mat", "log.signals[1][1]"), [1, 3, 5, 7, 9])

    def test_a_single_signal_is_a_structure_and_not_a_list_of_them(self):
        self.save(log={"time": self.time[:, None], "signals": {"values": self.time[:, None], "label": "x"}})
        self.assertEqual([c["name"] for c in self.look("a.mat")["columns"]], ["log.x"])

    def test_two_signals_of_one_label_keep_their_numbers(self):
        self.save(log=self.scope(("x", self.time[:, None]), ("x", 2 * self.time[:, None])))
        self.assertEqual([c["name"] for c in self.look("a.mat")["columns"]], ["log.signals[0]", "log.signals[1]"])

    def test_a_structure_without_time_is_refused(self):
        self.save(log=self.scope(("x", self.time[:, None]), time=np.zeros((0, 0))))
        self.assertIn("Structure With Time", self.refused("a.mat"))

    def test_signals_of_matrices_have_time_last(self):
        cube = np.arange(30.0).reshape(2, 3, 5)
        self.save(log=self.scope(("m", cube)))
        names = [c["name"] for c in self.look("a.mat")["columns"]]
        self.assertEqual(names, [f"log.m[{i}]" for i in range(6)])
        self.assertEqual(self.played("a.mat", "log.m[1]"), list(cube[1, 0, :]))  # column by column, as MATLAB counts
        self.save(t=self.time, cube=np.zeros((5, 2, 3)))
        self.assertIn("3 dimensions", self.refused("a.mat"))

    def test_timeseries_as_a_structure(self):
        for data in (np.arange(5.0)[:, None], np.arange(5.0).reshape(1, 1, 5)):
            self.save(ts={"Time": 1000 * self.time[:, None], "Data": data, "Name": "x", "Quality": np.zeros((0, 0)),
                          "TimeInfo": {"Units": "milliseconds", "Start": 0.0}, "DataInfo": {"Units": "mm"}})
            look = self.look("a.mat")
            self.assertEqual((look["time"]["sample_time_s"], look["time"]["unit"]), (0.001, "ms"))
            self.assertEqual([(c["name"], c["unit"]) for c in look["columns"]], [("ts.Data", "mm")])
            self.assertEqual(self.played("a.mat", "ts.Data", interpolation="hold"), [0, 0.001, 0.002, 0.003, 0.004])
        self.save(ts={"Time": self.time, "Data": self.time, "TimeInfo": {"Units": "fortnights"}})
        self.assertIn("fortnights", self.refused("a.mat"))

    def test_to_workspace_arrays(self):
        for time_name in ("tout", "t"):
            self.save(**{time_name: self.time[:, None], "yout": np.arange(15.0).reshape(5, 3), "K": np.arange(3.0).reshape(3, 1)[:1]})
            look = self.look("a.mat")
            self.assertEqual(look["time"]["column"], time_name)
            self.assertEqual([c["name"] for c in look["columns"]], ["yout[0]", "yout[1]", "yout[2]"])
            self.assertEqual(self.played("a.mat", "yout[1]"), [1, 4, 7, 10, 13])

    def test_the_time_tells_the_length_and_not_the_longest_variable(self):
        self.save(t=self.time, wide=np.zeros((5, 8)), x=self.time)
        self.assertEqual(len(self.look("a.mat")["columns"]), 9)
        self.save(t=self.time, K=np.arange(8.0))
        self.assertIn('"K"', self.refused("a.mat"))

    def test_a_square_matrix_is_refused(self):
        self.save(t=self.time, square=np.arange(25.0).reshape(5, 5))
        self.assertIn("either may be the signals", self.refused("a.mat"))

    def test_logs_of_two_rates_are_refused_by_name(self):
        self.save(a={"time": self.time, "y": self.time}, b={"time": self.time[:3], "y": self.time[:3]})
        self.assertIn('"b.time" is a 1×3 matrix beside columns of 5 rows', self.refused("a.mat"))


class Experiment(InFolder):
    """Columns with scale and offset, and parts of records: what is compared and what is played are the same."""

    def setUp(self):
        super().setUp()
        self.raw = np.round(1000 * np.sin(np.arange(400) / 40))
        time = np.arange(400) * 2.0  # ms
        rows = "".join(f"{t:.0f},{c:.0f},{c * 2 + 5:.0f}\n" for t, c in zip(time, self.raw))
        self.write("a.csv", "tick,counts [V],u\n" + rows)
        self.write("pass.json", {"loopwright": 1, "solver": {"method": "euler", "stop": 1}, "blocks": {
            "in": {"type": "Constant", "value": {"value": 0, "unit": "m"}},
            "out": {"type": "Gain", "gain": 1, "in": {"u": "in.y"}}}, "log": ["out.y"]})
        self.columns = {"t": {"column": "tick", "unit": "ms"},
                        "x": {"column": "counts", "scale": 2e-3, "offset": "1 mm", "unit": "mm"}}

    def compare(self, code=0, **changes):
        experiment = {"loopwright": 1, "data": "a.csv", "time": "t", "columns": self.columns,
                      "drive": {"out.u": {"column": "x"}}, "compare": {"out.y": {"column": "x"}}, **changes}
        self.write("e.json", experiment)
        done = self.run_program("compare", "pass.json", "e.json", "--json", "-", code=code)
        return json.loads(done.stdout) if code == 0 else done.stderr

    def test_what_is_played_is_what_is_compared(self):
        for excerpt in (None, {"skip": 7}, {"from": "0.1 s", "to": "500 ms"}, {"from": 0.1, "decimate": 3}):
            with self.subTest(excerpt):
                result = self.compare(**({"excerpt": excerpt} if excerpt else {}))
                self.assertEqual(result["signals"]["out.y"]["max_abs"], 0)

    def test_the_rows_of_an_excerpt(self):
        self.assertEqual(self.compare()["rows"], 400)
        self.assertEqual(self.compare(excerpt={"skip": 7})["rows"], 393)
        self.assertEqual(self.compare(excerpt={"from": "0.1 s", "to": "500 ms"})["rows"], 201)
        self.assertEqual(self.compare(excerpt={"from": 0.1, "to": 0.5, "decimate": 4})["rows"], 51)

    def test_the_numbers_are_scaled(self):
        self.write("play.json", {"loopwright": 1, "solver": {"method": "euler", "step": 0.002, "stop": 0.798}, "log": ["c.value"], "blocks": {
            "c": {"type": "RecordedColumn", "file": "a.csv", "column": "x", "time": "t", "experiment": "e.json"}}})
        self.compare()
        lines = self.run_program("run", "play.json", "-o", "-", "-q").stdout.splitlines()
        numbers = [float(line.split(",")[1]) for line in lines if line[0].isdigit()]
        np.testing.assert_allclose(numbers, 1e-3 * (2e-3 * self.raw + 1), rtol=1e-15, atol=1e-18)

    def test_mistakes_are_refused(self):
        self.assertIn("another unit", self.compare(2, columns={**self.columns, "x": {"column": "counts", "unit": "mV", "scale": 1}}))
        self.assertIn("another unit", self.compare(2, columns={**self.columns, "x": {"column": "counts", "unit": "mm"}}))
        self.assertIn("already have", self.compare(2, columns={**self.columns, "u": {"column": "counts"}}))
        self.assertIn("no column", self.compare(2, columns={**self.columns, "x": {"column": "count"}}))
        self.assertIn("did you mean", self.compare(2, columns={**self.columns, "x": {"colum": "counts"}}))
        self.assertIn("0 of the 400 rows", self.compare(2, excerpt={"from": 5, "to": 6}))
        self.assertIn("ends before", self.compare(2, excerpt={"from": 2, "to": 1}))
        self.assertIn("whole numbers", self.compare(2, excerpt={"skip": 1.5}))
        self.assertIn("m", self.compare(2, excerpt={"from": "1 m"}))
        self.assertIn("scale of 0", self.compare(2, columns={**self.columns, "x": {"column": "counts", "unit": "mm", "scale": 0}}))

    def test_one_of_two_recordings_in_a_file(self):
        with open(self.path("a.csv")) as file:
            heading, *rows = file.read().splitlines()
        self.write("a.csv", "\n".join([heading, *rows, *rows]) + "\n")
        self.assertIn("goes back", self.compare(2))
        self.assertEqual(self.compare(excerpt={"skip": 400})["signals"]["out.y"]["max_abs"], 0)


class Results(InFolder):
    def setUp(self):
        super().setUp()
        self.write("d.json", {"loopwright": 1, "solver": {"stop": 1, "record_step": 0.1}, "log": ["a.y", "b.y"], "blocks": {
            "a": {"type": "Sine", "frequency": 1, "amplitude": {"value": 1e-7, "unit": "m"}},
            "b": {"type": "Constant", "value": -3.25}}})
        text = self.run_program("run", "d.json", "-q", "-o", "-").stdout
        self.rows = [[float(v) for v in line.split(",")] for line in text.splitlines() if line[0].isdigit()]

    def test_a_table_for_excel(self):
        self.run_program("run", "d.json", "-q", "-o", "x.csv", "--excel")
        with open(self.path("x.csv"), "rb") as file:
            raw = file.read()
        self.assertTrue(raw.startswith(b"\xef\xbb\xbf"))
        self.assertNotIn(b"#", raw)
        table = list(csv.reader(raw.decode("utf-8-sig").split("\r\n")[:-1], delimiter=";"))
        self.assertEqual(table[0], ["time [s]", "a.y [m]", "b.y"])
        self.assertEqual([[float(cell.replace(",", ".")) for cell in row] for row in table[1:]], self.rows)
        self.assertEqual(self.run_program("run", "d.json", "-q", "-o", "-", "--excel").stdout.encode().replace(b"\n", b""),
                         raw.replace(b"\r\n", b""))
        self.assertIn("Excel", self.run_program("run", "d.json", "-o", "x.mat", "--excel", code=2).stderr)

    def test_hdf5(self):
        self.run_program("run", "d.json", "-q", "-o", "x.h5")
        with h5py.File(self.path("x.h5")) as file:
            for i, name in enumerate(["time", "a.y", "b.y"]):
                self.assertEqual(list(file[name][:]), [row[i] for row in self.rows])
            self.assertEqual([file[name].attrs["unit"] for name in ("time", "a.y")], ["s", "m"])
            facts = {key.decode(): value.decode() for key, value in file["loopwright_facts"][:]}
            self.assertIn("plan", facts)
        with open(self.path("x.h5"), "rb") as file:
            first = file.read()
        time.sleep(1.1)  # [s], the library states times in whole seconds
        self.run_program("run", "d.json", "-q", "-o", "x.h5")
        with open(self.path("x.h5"), "rb") as file:
            self.assertEqual(file.read(), first)
        self.assertIn("written, not read", self.refused("x.h5"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
