"""Values of a diagram from MAT files that SciPy and h5py write, held against numpy.

    /usr/bin/python3 tests/reference/mat_value_test.py build/release/bin/loopwright
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy
import scipy.io

program = str(pathlib.Path(sys.argv[1]).resolve())

K = numpy.array([[1.5, 2.25, -3.0], [4.0, 5.0, 6.125]])
STRUCTURE = {"K": K, "plant": {"mass": 0.75, "motor": {"gains": numpy.array([1.0, 2.0, 3.0])}},
             "poles": numpy.array([(-3.0, 0.5), (-7.0, 2.5)], dtype=[("re", "O"), ("im", "O")]),
             "upright": numpy.array([[1.0], [2.0]]), "whole": numpy.int16(7), "small": numpy.float32(0.5), "on": True,
             "names": numpy.array(["a", "b"], dtype=object), "word": "linear", "z": 1 + 2j, "empty": numpy.zeros((0, 0)),
             "holed": numpy.array([1.0, numpy.nan])}


def write_73(path, arrays):
    """As MATLAB writes version 7.3: a header before the HDF5 file, and the axes of every array in reverse."""
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, array in arrays.items():
            data = file.create_dataset(name, data=numpy.atleast_2d(array).T)
            data.attrs.create("MATLAB_class", numpy.bytes_("double"), dtype="S7")  # matio needs the final zero
        group = file.create_group("plant")
        group.attrs.create("MATLAB_class", numpy.bytes_("struct"), dtype="S7")
        mass = group.create_dataset("mass", data=numpy.array([[0.75]]))
        mass.attrs.create("MATLAB_class", numpy.bytes_("double"), dtype="S7")
    with open(path, "r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM")


class MatValues(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def run_diagram(self, blocks, log, code=0, **more):
        diagram = {"loopwright": 1, "solver": {"method": "rk4", "step": 1, "stop": 1}, "blocks": blocks, "log": log, **more}
        (self.folder / "d.json").write_text(json.dumps(diagram, indent=1))
        done = subprocess.run([program, "run", "d.json", "-q", "-o", "-"], capture_output=True, encoding="utf-8", cwd=self.folder)
        self.assertEqual(done.returncode, code, done.stderr)
        if code:
            return done.stderr
        return [float(cell) for cell in done.stdout.splitlines()[-1].split(",")[1:]]

    def constant(self, name):
        return self.run_diagram({"c": {"type": "Constant", "value": {"file": "v.mat", "name": name}}}, ["c.y"])

    def product(self, name, vector):
        return self.run_diagram({"u": {"type": "Constant", "value": vector},
                                 "k": {"type": "MatrixGain", "matrix": {"file": "v.mat", "name": name}, "in": {"u": "u.y"}}}, ["k.y"])

    def test_version_5_of_scipy(self):
        for compressed in (False, True):
            scipy.io.savemat(self.folder / "v.mat", STRUCTURE, do_compression=compressed)
            self.check()
            self.assertEqual(self.constant("plant.motor.gains"), [1, 2, 3])
            self.assertEqual(self.constant("poles.1.im"), [2.5])
            self.assertEqual(self.constant("whole"), [7])
            self.assertEqual(self.constant("small"), [0.5])

    def test_version_4_of_scipy(self):
        scipy.io.savemat(self.folder / "v.mat", {"K": K, "row": numpy.array([[1.0, 2.0]])}, format="4")
        self.assertEqual(self.product("K", [1, 10, 100]), list(K @ [1, 10, 100]))

    def test_version_73_of_h5py(self):
        write_73(self.folder / "v.mat", {"K": K, "upright": numpy.array([[1.0], [2.0]])})
        self.check()

    def check(self):
        self.assertEqual(self.product("K", [1, 10, 100]), list(K @ [1, 10, 100]))
        self.assertEqual(self.constant("upright"), [1, 2])
        self.assertEqual(self.constant("K.0.2"), [-3])
        self.assertEqual(self.constant("plant.mass"), [0.75])

    def test_one_column_is_a_matrix_of_one_column(self):
        scipy.io.savemat(self.folder / "v.mat", STRUCTURE)
        done = self.run_diagram({"u": {"type": "Constant", "value": 3},
                                 "k": {"type": "MatrixGain", "matrix": {"file": "v.mat", "name": "upright"}, "in": {"u": "u.y"}}}, ["k.y"])
        self.assertEqual(done, [3, 6])

    def refused(self, name):
        text = self.run_diagram({"c": {"type": "Constant", "value": {"file": "v.mat", "name": name}}}, ["c.y"], code=2)
        self.assertRegex(text, r"d\.json:\d+:\d+")
        return text

    def test_what_cannot_be_used_is_refused_at_its_place(self):
        scipy.io.savemat(self.folder / "v.mat", STRUCTURE)
        self.assertIn("complex numbers", self.refused("z"))
        self.assertIn("nan at holed.1", self.refused("holed"))
        self.assertIn('the text "linear"', self.refused("word"))
        self.assertIn("did you mean \"upright\"?", self.refused("uprigth"))
        self.assertIn("this is no value", self.refused("plant"))

    def test_the_bytes_of_the_file_belong_to_the_result(self):
        facts = set()
        for unused in (1, 2):
            scipy.io.savemat(self.folder / "v.mat", {"k": 1.0, "unused": unused})
            self.constant("k")
            done = subprocess.run([program, "run", "d.json", "-q", "-o", "r.csv"], cwd=self.folder, capture_output=True, encoding="utf-8")
            self.assertEqual(done.returncode, 0, done.stderr)
            facts.add("\n".join(line for line in (self.folder / "r.csv").read_text().splitlines() if "v.mat" in line))
        self.assertEqual(len(facts), 2, facts)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
