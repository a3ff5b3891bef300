"""`loopwright design` and the Kalman block, compared with SciPy's Riccati solvers and with filters in plain Python.

    /usr/bin/python3 tests/reference/design_test.py build/release/bin/loopwright
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy
import scipy.linalg
import scipy.signal

import diagrams
from diagrams import constant, run

diagrams.program = sys.argv[1]


class Design:
    """A diagram in a folder of its own, designed for."""

    def __init__(self, blocks, solver=None, **more):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)
        diagram = {"loopwright": 1, "solver": solver or {"stop": 1, "step": 0.001}, "blocks": blocks, **more}
        (self.path / "plant.json").write_text(json.dumps(diagram))

    def __del__(self):
        self.folder.cleanup()

    def __call__(self, kind, *arguments, code=0):
        command = [diagrams.program, "design", kind, "plant.json", "--json", "out.json", *arguments]
        done = subprocess.run(command, capture_output=True, text=True, cwd=self.path)
        if done.returncode != code:
            raise AssertionError(f"{done.returncode}: {done.stdout}{done.stderr}")
        if code:
            return done.stderr
        result = json.loads((self.path / "out.json").read_text())
        return {key: numpy.array(value) if key in ("A", "B", "C", "D", "Q", "R", "N", "K", "X", "gain", "predictor", "P")
                else value for key, value in result.items()}


def plant(A, B, C):
    return {"type": "StrictlyProperStateSpace", "A": A.tolist(), "B": B.tolist(), "C": C.tolist(),
            "in": {"u": "u.y"}}


def several(values):
    return {"type": "Constant", "value": list(values)} if len(values) > 1 else {"type": "Constant", "value": values[0]}


def poles_of(result):
    return sorted((p["re"] + 1j * p["im"] for p in result["poles"]), key=lambda z: (z.real, z.imag))


def sorted_poles(values):
    return sorted(values, key=lambda z: (z.real, z.imag))


two_mass = {  # kg, N/m, N*s/m; states: x1, v1, x2, v2
    "force": constant(0, "N"),
    "net": {"type": "Sum", "signs": "+-", "in": {"terms": ["force.y", "spring.force"]}},
    "motor": {"type": "Mass", "mass": {"value": 0.5, "unit": "kg"}, "in": {"force": "net.sum"}},
    "load": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "in": {"force": "spring.force"}},
    "spring": {"type": "ElasticCoupling", "stiffness": {"value": 9e4, "unit": "N/m"}, "damping": {"value": 6, "unit": "N*s/m"},
               "in": {"motor_position": "motor.position", "motor_velocity": "motor.velocity",
                      "load_position": "load.position", "load_velocity": "load.velocity"}}}
k, c, m1, m2 = 9e4, 6.0, 0.5, 2.0
two_mass_A = numpy.array([[0, 1, 0, 0], [-k / m1, -c / m1, k / m1, c / m1], [0, 0, 0, 1], [k / m2, c / m2, -k / m2, -c / m2]])
two_mass_B = numpy.array([[0], [1 / m1], [0], [0]])


class Regulators(unittest.TestCase):
    def test_random_systems_continuous_and_sampled(self):
        random = numpy.random.default_rng(11)
        for order, inputs in ((1, 1), (2, 1), (4, 2), (7, 3), (12, 2)):
            A, B = random.normal(size=(order, order)), random.normal(size=(order, inputs))
            weights, efforts = random.uniform(0.1, 10, order), random.uniform(0.1, 10, inputs)
            design = Design({"u": several(numpy.zeros(inputs).tolist()), "x": plant(A, B, numpy.eye(order))})
            names = ["x"] if order == 1 else [f"x[{i}]" for i in range(order)]
            ports = ["x.u"] if inputs == 1 else [f"x.u[{i}]" for i in range(inputs)]
            arguments = ["--from", "x.u"]
            for name, weight in zip(names, weights):
                arguments += ["--Q", f"{name}={weight!r}"]
            for port, weight in zip(ports, efforts):
                arguments += ["--R", f"{port}={weight!r}"]
            Q, R = numpy.diag(weights), numpy.diag(efforts)
            found = design("lqr", *arguments)
            X = scipy.linalg.solve_continuous_are(A, B, Q, R)
            K = numpy.linalg.solve(R, B.T @ X)
            numpy.testing.assert_allclose(found["K"], K, rtol=1e-8, atol=1e-8 * abs(K).max())
            numpy.testing.assert_allclose(found["X"], X, rtol=1e-8, atol=1e-8 * abs(X).max())
            numpy.testing.assert_allclose(poles_of(found), sorted_poles(numpy.linalg.eigvals(A - B @ K)), rtol=1e-6, atol=1e-6)
            self.assertLess(found["residual"], 1e-12)
            T = 0.05
            Ad, Bd, *_ = scipy.signal.cont2discrete((A, B, numpy.eye(order), numpy.zeros((order, inputs))), T)
            found = design("lqr", *arguments, "--sample-time", str(T))
            X = scipy.linalg.solve_discrete_are(Ad, Bd, Q, R)
            K = numpy.linalg.solve(R + Bd.T @ X @ Bd, Bd.T @ X @ Ad)
            numpy.testing.assert_allclose(found["K"], K, rtol=1e-8, atol=1e-8 * abs(K).max())
            numpy.testing.assert_allclose(found["X"], X, rtol=1e-8, atol=1e-8 * abs(X).max())
            self.assertLess(found["residual"], 1e-12)

    def test_a_drive_with_an_elastic_load_in_units(self):
        """Micrometres beside newtons: the weights of the states differ by eight orders of size."""
        design = Design(two_mass)
        T = 2.5e-4
        found = design("lqr", "--from", "net.terms[0]", "--allow", "load.position=5 um", "--allow", "load.velocity=20 mm/s",
                       "--allow", "net.terms[0]=40 N", "--sample-time", str(T))
        names = [state["name"] for state in found["states"]]
        self.assertEqual(names, ["motor.position", "motor.velocity", "load.position", "load.velocity"])
        self.assertEqual([state["unit"] for state in found["states"]], ["m", "m/s", "m", "m/s"])
        A, B, *_ = scipy.signal.cont2discrete((two_mass_A, two_mass_B, numpy.eye(4), numpy.zeros((4, 1))), T)
        numpy.testing.assert_allclose(found["A"], A, atol=1e-9)
        Q, R = numpy.diag([0, 0, 1 / 5e-6**2, 1 / 0.02**2]), numpy.array([[1 / 40**2]])
        X = scipy.linalg.solve_discrete_are(A, B, Q, R)
        K = numpy.linalg.solve(R + B.T @ X @ B, B.T @ X @ A)
        numpy.testing.assert_allclose(found["K"], K, rtol=1e-6)
        weights = design("lqr", "--from", "net.terms[0]", "--Q", "load.position=4e10 1/m^2", "--Q", "load.velocity=2.5e-3 s^2/mm^2",
                         "--R", "net.terms[0]=625 1/kN^2", "--sample-time", str(T))
        numpy.testing.assert_allclose(weights["K"], found["K"], rtol=1e-9)

    def test_a_weighted_port_has_cross_terms(self):
        """The acceleration of the motor contains the force: its weight couples states and command."""
        design = Design(two_mass)
        found = design("lqr", "--from", "net.terms[0]", "--Q", "motor.acceleration=0.01", "--Q", "load.position=1e6",
                       "--R", "net.terms[0]=0.001")
        C, D = two_mass_A[1:2], numpy.array([[1 / m1]])
        Q, R, N = 0.01 * C.T @ C, 0.001 + 0.01 * D.T @ D, 0.01 * C.T @ D
        Q[2, 2] += 1e6
        numpy.testing.assert_allclose(found["N"], N, rtol=1e-7, atol=1e-6 * abs(N).max())
        X = scipy.linalg.solve_continuous_are(two_mass_A, two_mass_B, Q, R, s=N)
        K = numpy.linalg.solve(R, two_mass_B.T @ X + N.T)
        numpy.testing.assert_allclose(found["K"], K, rtol=1e-6)

    def test_a_delay_makes_a_singular(self):
        """One sample of delay before a mass: A has a pole at z = 0."""
        T, m = 0.001, 0.4
        blocks = {"u": constant(0, "N"), "late": {"type": "UnitDelay", "sample_time": T, "in": {"u": "u.y"}},
                  "stage": {"type": "Mass", "mass": {"value": m, "unit": "kg"}, "in": {"force": "late.y"}}}
        found = Design(blocks)("lqr", "--from", "late.u", "--Q", "stage.position=1e8 1/m^2", "--R", "late.u=1 1/N^2")
        A = numpy.array([[1, T, T * T / 2 / m], [0, 1, T / m], [0, 0, 0]])
        B = numpy.array([[0], [0], [1.0]])
        Q = numpy.diag([1e8, 0, 0])
        X = scipy.linalg.solve_discrete_are(A, B, Q, numpy.eye(1))
        K = numpy.linalg.solve(numpy.eye(1) + B.T @ X @ B, B.T @ X @ A)
        self.assertEqual([s["name"] for s in found["states"]][:2], ["stage.position", "stage.velocity"])
        numpy.testing.assert_allclose(found["K"], K, rtol=1e-8)

    def test_the_written_diagram_closes_the_loop(self):
        """The subdiagram in the diagram that it was designed for moves as x[k+1] = (A - B K) x[k]."""
        T = 0.001
        design = Design(two_mass, outputs={})
        found = design("lqr", "--from", "net.terms[0]", "--allow", "load.position=20 um", "--allow", "net.terms[0]=40 N",
                       "--sample-time", str(T), "-o", "feedback.json")
        names = ["motor.position", "motor.velocity", "load.position", "load.velocity"]
        closed = json.loads(json.dumps(two_mass))
        closed["load"]["initial_position"] = closed["motor"]["initial_position"] = {"value": 1, "unit": "mm"}
        del closed["force"]
        for i, name in enumerate(names):
            closed[f"s{i}"] = {"type": "ZeroOrderHold", "sample_time": T, "in": {"u": name}}
        ports = ["motor_position", "motor_velocity", "load_position", "load_velocity"]
        closed["feedback"] = {"diagram": "feedback.json", "in": {p: f"s{i}.y" for i, p in enumerate(ports)}}
        closed["net"]["in"]["terms"][0] = "feedback.terms_0"
        (design.path / "closed.json").write_text(json.dumps({
            "loopwright": 1, "solver": {"method": "dopri5", "stop": 0.1, "relative_tolerance": 1e-11, "absolute_tolerance": 1e-14,
                                        "record_step": T}, "blocks": closed, "log": ["load.position"]}))
        done = subprocess.run([diagrams.program, "run", "closed.json", "--strict-units", "-o", "out.csv"], cwd=design.path,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = [l for l in (design.path / "out.csv").read_text().splitlines() if not l.startswith("#")][1:]
        A, B, *_ = scipy.signal.cont2discrete((two_mass_A, two_mass_B, numpy.eye(4), numpy.zeros((4, 1))), T)
        x = numpy.array([1e-3, 0, 1e-3, 0])
        for line in lines:
            self.assertAlmostEqual(float(line.split(",")[1]), x[2], delta=1e-10)
            x = (A - B @ found["K"]) @ x


class Refusals(unittest.TestCase):
    def test_modes_are_named(self):
        free = {"u": constant(0, "N"), "a": {"type": "Mass", "mass": {"value": 1, "unit": "kg"}, "in": {"force": "u.y"}},
                "b": {"type": "Mass", "mass": {"value": 1, "unit": "kg"}, "in": {"force": "z.y"}}, "z": constant(0, "N")}
        design = Design(free)
        text = design("lqr", "--from", "a.force", "--Q", "a.position=1", "--Q", "b.position=1", "--R", "a.force=1", code=2)
        self.assertIn("uncontrollable", text)
        self.assertIn("b.", text)
        self.assertNotIn("(a.", text)
        text = design("lqr", "--from", "a.force", "--Q", "a.position=1", "--R", "a.force=1", code=2)
        self.assertIn("nothing weighted depends on the mode", text)
        self.assertIn("--without", text)
        found = design("lqr", "--from", "a.force", "--Q", "a.position=1", "--R", "a.force=1", "--without", "b")
        numpy.testing.assert_allclose(found["K"], [[1, numpy.sqrt(2)]], rtol=1e-12)  # the closed form
        text = design("kalman", "--to", "a.velocity", "--Q", "a.force=1 N^2*s", "--R", "a.velocity=1 m^2/s", "--without", "b", code=2)
        self.assertIn("nothing measured depends on the mode", text)
        self.assertIn("a.position", text)

    def test_a_hidden_mode(self):
        """Two equal modes seen through their sum: undetectable, though every state is connected."""
        A = numpy.array([[0.5, 0.0], [0.0, 0.5]])
        blocks = {"u": constant(0), "x": plant(A, numpy.array([[1.0], [1.0]]), numpy.array([[1.0, 1.0]]))}
        text = Design(blocks)("kalman", "--to", "x.y", "--Q", "x=1", "--R", "x.y=1", code=2)
        self.assertIn("undetectable", text)
        self.assertIn("s = 0.5", text)
        text = Design(blocks)("lqr", "--from", "x.u", "--Q", "x=1", "--R", "x.u=1", code=2)
        self.assertIn("uncontrollable", text)
        oscillator = {"u": constant(0), "x": plant(numpy.array([[0.0, 3.0], [-3.0, 0.0]]), numpy.array([[0.0], [1.0]]), numpy.eye(2)),
                      "slow": {"type": "LowPass", "order": 1, "cutoff": 1, "in": {"u": "x.y[0]"}}}
        found = Design(oscillator)("lqr", "--from", "x.u", "--Q", "slow=1", "--R", "x.u=1")
        self.assertLess(found["residual"], 1e-10)

    def test_units_names_and_missing_weights(self):
        design = Design(two_mass)
        for arguments, expected in (
                (["--from", "net.terms[0]", "--Q", "load.position=1 m", "--R", "net.terms[0]=1"], "another unit"),
                (["--from", "net.terms[0]", "--Q", "load.positon=1", "--R", "net.terms[0]=1"], "did you mean"),
                (["--from", "net.terms[0]", "--Q", "load.position=1"], "has no weight"),
                (["--from", "net.terms[0]", "--R", "net.terms[0]=1"], "no state has a weight"),
                (["--from", "net.terms[0]", "--Q", "load.position=-1", "--R", "net.terms[0]=1"], "negative"),
                (["--from", "net.terms[0]", "--Q", "load.position", "--R", "net.terms[0]=1"], "NAME=NUMBER"),
                (["--Q", "load.position=1"], "--from PORT"),
                (["--from", "net.terms[0]", "--Q", "load.position=1", "--R", "net.terms[1]=1"], "not one of the ports")):
            self.assertIn(expected, design("lqr", *arguments, code=2), arguments)


class Filters(unittest.TestCase):
    def test_random_systems(self):
        random = numpy.random.default_rng(5)
        for order, measured in ((2, 1), (5, 2), (9, 3)):
            A, C = random.normal(size=(order, order)), random.normal(size=(measured, order))
            process, noise = random.uniform(0.1, 10, order), random.uniform(0.1, 10, measured)
            design = Design({"u": constant(0), "x": plant(A, numpy.ones((order, 1)), C)})
            ports = ["x.y"] if measured == 1 else [f"x.y[{i}]" for i in range(measured)]
            arguments = ["--from", "x.u", "--to", "x.y"]
            for i, q in enumerate(process):
                arguments += ["--Q", f"x[{i}]={q!r}"]
            for port, r in zip(ports, noise):
                arguments += ["--R", f"{port}={r!r}"]
            Q, R, T = numpy.diag(process), numpy.diag(noise), 0.1
            found = design("kalman", *arguments)
            P = scipy.linalg.solve_continuous_are(A.T, C.T, Q, R)
            numpy.testing.assert_allclose(found["gain"], P @ C.T @ numpy.linalg.inv(R), rtol=1e-7, atol=1e-9)
            found = design("kalman", *arguments, "--sample-time", str(T))
            Ad = scipy.linalg.expm(A * T)
            P = scipy.linalg.solve_discrete_are(Ad.T, C.T, Q, R)
            M = P @ C.T @ numpy.linalg.inv(C @ P @ C.T + R)
            numpy.testing.assert_allclose(found["P"], P, rtol=1e-8, atol=1e-9)
            numpy.testing.assert_allclose(found["gain"], M, rtol=1e-8, atol=1e-9)
            numpy.testing.assert_allclose(found["predictor"], Ad @ M, rtol=1e-8, atol=1e-9)

    def test_noise_at_a_port(self):
        """A force disturbance, held over a sample, through the exact input matrix."""
        T = 0.001
        found = Design(two_mass)("kalman", "--from", "net.terms[0]", "--to", "motor.position", "--deviation", "spring.force=0.2 N",
                                 "--deviation", "net.sum=3 N", "--deviation", "motor.position=1 um", "--sample-time", str(T))
        force = numpy.array([[0, 0], [1 / m1, -1 / m1], [0, 0], [0, 1 / m2]])  # net.sum, spring.force on both masses
        A, G, *_ = scipy.signal.cont2discrete((two_mass_A, force, numpy.eye(4), numpy.zeros((4, 2))), T)
        Q = G @ numpy.diag([9, 0.04]) @ G.T
        C = numpy.array([[1.0, 0, 0, 0]])
        P = scipy.linalg.solve_discrete_are(A.T, C.T, Q, numpy.array([[1e-12]]))
        numpy.testing.assert_allclose(found["Q"], Q, rtol=1e-6, atol=1e-20)
        numpy.testing.assert_allclose(found["P"], P, rtol=1e-4, atol=1e-7 * abs(P).max())


class KalmanBlock(unittest.TestCase):
    T = 0.01
    A = numpy.array([[1.0, 0.01, 0.0], [-0.3, 0.98, 0.01], [0.0, 0.0, 1.0]])
    B = numpy.array([[0.0, 0.01], [0.02, 0.0], [0.0, 0.0]])
    C = numpy.array([[1.0, 0, 0], [0.0, 1.0, 0.2]])
    Q = numpy.diag([1e-6, 1e-4, 1e-3]) + 1e-6
    R = numpy.array([[0.01, 0.002], [0.002, 0.04]])

    def blocks(self, **more):
        signal = lambda f, p: {"type": "Sine", "amplitude": 1, "frequency": f, "phase": p, "sample_time": self.T}
        return {"a": signal(1.0, 0.3), "b": signal(2.0, 0), "y0": signal(0.7, 1), "y1": signal(1.3, 2),
                "filter": {"type": "Kalman", "sample_time": self.T,
                           "states": [{"name": "x"}, {"name": "v"}, {"name": "d"}],
                           "measurements": [{"name": "p"}, {"name": "q"}],
                           "A": self.A.tolist(), "B": self.B.tolist(), "C": self.C.tolist(), "Q": self.Q.tolist(),
                           "R": self.R.tolist(), "initial": [0.1, -0.2, 0.3],
                           "in": {"inputs": ["a.y", "b.y"], "p": "y0.y", "q": "y1.y"}, **more}}

    def check(self, P, varies, tolerance, **more):
        log = ["filter.x", "filter.v", "filter.d", "a.y", "b.y", "y0.y", "y1.y"]
        out = run(self.blocks(**more), {"stop": 3, "step": self.T}, log)
        x = numpy.array([0.1, -0.2, 0.3])
        for row in range(len(out["time"])):
            M = P @ self.C.T @ numpy.linalg.inv(self.C @ P @ self.C.T + self.R)
            estimate = x + M @ (numpy.array([out["y0.y"][row], out["y1.y"][row]]) - self.C @ x)
            numpy.testing.assert_allclose([out[name][row] for name in log[:3]], estimate, atol=tolerance)
            x = self.A @ estimate + self.B @ numpy.array([out["a.y"][row], out["b.y"][row]])
            if varies:
                P = self.A @ (P - M @ self.C @ P) @ self.A.T + self.Q

    def test_steady(self):
        self.check(scipy.linalg.solve_discrete_are(self.A.T, self.C.T, self.Q, self.R), False, 1e-9)

    def test_time_varying(self):
        start = numpy.diag([1.0, 4.0, 0.0])
        self.check(start, True, 1e-9, gain="time_varying", initial_covariance=start.tolist())

    def test_a_noisy_drive(self):
        """The variance of the error over a long run is that of the Riccati equation."""
        T, m, process, noise = 0.01, 1.0, 0.5, 0.02
        A, B = numpy.array([[1, T], [0, 1]]), numpy.array([[T * T / 2], [T]]) / m
        Q = B @ B.T * process**2
        blocks = {"w": {"type": "Noise", "standard_deviation": {"value": process, "unit": "N"}, "sample_time": T},
                  "u": {"type": "Sine", "amplitude": {"value": 1, "unit": "N"}, "frequency": 0.2, "sample_time": T},
                  "force": {"type": "Sum", "in": {"terms": ["w.y", "u.y"]}},
                  "stage": {"type": "Mass", "mass": {"value": m, "unit": "kg"}, "in": {"force": "force.sum"}},
                  "v": {"type": "Noise", "standard_deviation": {"value": noise, "unit": "m"}, "stream": 1, "sample_time": T},
                  "measured": {"type": "Sum", "in": {"terms": ["stage.position", "v.y"]}},
                  "filter": {"type": "Kalman", "sample_time": T, "states": [{"name": "x", "unit": "m"}, {"name": "v", "unit": "m/s"}],
                             "measurements": [{"name": "position", "unit": "m"}], "A": A.tolist(), "B": B.tolist(), "C": [[1, 0]],
                             "Q": Q.tolist(), "R": [[noise**2]], "in": {"inputs": ["u.y"], "position": "measured.sum"}}}
        out = run(blocks, {"stop": 4000, "step": T}, ["filter.x", "filter.v", "stage.position", "stage.velocity"])
        P = scipy.linalg.solve_discrete_are(A.T, numpy.array([[1.0], [0.0]]), Q, numpy.array([[noise**2]]))
        C = numpy.array([[1.0, 0.0]])
        after = P - P @ C.T @ C @ P / (P[0, 0] + noise**2)
        error = numpy.array([out["filter.x"] - out["stage.position"], out["filter.v"] - out["stage.velocity"]])[:, 1000:]
        numpy.testing.assert_allclose(error @ error.T / error.shape[1], after, rtol=0.05)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
