"""Loopwright in Python: load, run, step, sweep, compare, fit, diagnose and linearize block diagrams.

The names are those of the command line, and so are the numbers: the module calls the functions that the commands
call. Runs and answers are in SI units; a recording that was read has the units of its file, which `units` names.
docs/python.md is the guide.
"""

import html as _html
import json as _json
import os as _os
import pathlib as _pathlib
import tempfile as _tempfile

from . import _core
from ._core import InputError, Problem, Snapshot
from ._recording import Recording

__all__ = ["Answer", "Diagnosis", "Diagram", "Fit", "InputError", "Linear", "Problem", "Recording", "Run", "RunError", "Snapshot",
           "Stepper", "Sweep", "compare", "diagnose", "fit", "linearize", "load", "read", "sweep"]


def _find_prefix():
    """The folder with share/loopwright, above the module: in a build tree as well as installed."""
    for folder in _pathlib.Path(_core.__file__).resolve().parents:
        if (folder / "share" / "loopwright").is_dir():
            return str(folder)
    raise ImportError(f"there is no share/loopwright above {_core.__file__}: the installation is incomplete")


_core.set_prefix(_find_prefix())


class RunError(RuntimeError):
    """A run that failed. `result` holds what was computed until then."""

    def __init__(self, message, result):
        super().__init__(message)
        self.result = result


def _frame(page):
    """A page inside a notebook; isolated, so that its styles and scripts stay its own."""
    return ('<iframe sandbox="allow-scripts" style="width:100%;height:640px;border:0" '
            f'srcdoc="{_html.escape(page, quote=True)}"></iframe>')


def _write(path, text):
    """Completely or not at all."""
    path = _os.fspath(path)
    handle, name = _tempfile.mkstemp(dir=_os.path.dirname(path) or ".", suffix=".part")
    try:
        with _os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text)
        _os.chmod(name, 0o644)
        _os.replace(name, path)
    except BaseException:
        _os.unlink(name)
        raise


def _setting(value):
    """A value of `set=` as `--set` reads it: text as it is, so that "0.2 kg" keeps its unit."""
    if isinstance(value, str):
        return value
    return _json.dumps(value.tolist() if hasattr(value, "tolist") else value)


class Run(Recording):
    """A finished run: its recording, how it ended, and its page."""

    def __init__(self, run):
        super().__init__(run.columns)
        self._run = run

    @property
    def status(self):
        """"finished", or "failed" with the reason in `message`."""
        return self._run.status

    @property
    def message(self):
        return self._run.message

    @property
    def warnings(self):
        return self._run.warnings

    @property
    def statistics(self):
        return self._run.statistics()

    def report(self, path):
        """Writes the page of `loopwright run --report`."""
        self._run.report(_os.fspath(path))

    def __str__(self):
        return self._run.summary()

    def _repr_html_(self):
        return _frame(self._run.html())


class Stepper:
    """A diagram advanced step by step, with the numbers of a run. It needs a fixed-step method.

    with diagram.stepper() as stepper:
        stepper.set("stage.payload", "0.1 kg")
        stepper.advance(1e-3)
        stepper.get("stage.position")
    """

    def __init__(self, stepper):
        self._stepper = stepper

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return None

    @property
    def time(self):
        return self._stepper.time

    def set(self, path, value):
        """As `--set`, at the start only: some parameters enter the blocks when these are prepared."""
        self._stepper.set(path, _setting(value))

    def advance(self, duration):
        """By so many seconds: whole steps of the solver."""
        self._stepper.advance(duration)

    def advance_to(self, time):
        self._stepper.advance_to(time)

    def get(self, port):
        """The number of a port in SI, or a list of them."""
        numbers = self._stepper.numbers(port)
        return numbers[0] if len(numbers) == 1 else numbers

    def unit(self, port):
        return self._stepper.unit(port)

    def snapshot(self):
        """All numbers at this instant, for `restore`."""
        return self._stepper.snapshot()

    def restore(self, snapshot):
        self._stepper.restore(snapshot)

    def reset(self):
        """Back to the start."""
        self._stepper.reset()


class Answer:
    """What a command prints; `data` is what it writes with --json, and `answer[key]` a member of that."""

    def __init__(self, text, json, html=None):
        self._text, self._html = text, html
        self.data = _json.loads(json)

    def __getitem__(self, key):
        return self.data[key]

    def __str__(self):
        return self._text

    def report(self, path):
        """Writes the page that the command writes with --report."""
        if self._html is None:
            raise ValueError("this answer has no page")
        _write(path, self._html())

    def _repr_html_(self):
        return _frame(self._html()) if self._html else f"<pre>{_html.escape(self._text)}</pre>"


class Fit(Answer):
    """Fitted parameters. `text` is the diagram file with them; empty if its author wrote one as an expression."""

    def __init__(self, answer, text):
        super().__init__(answer.text, answer.json, answer.html)
        self.text = text


class Diagnosis(Answer):
    """The effects that a diagram lacks. `improved()` is the diagram with them, where it was written."""

    def __init__(self, answer, improved):
        super().__init__(answer.text, answer.json, answer.html)
        self._improved = improved

    def improved(self):
        if not self._improved or not _os.path.exists(self._improved):
            raise ValueError("the improved diagram was not written: give diagnose(…, improved=\"better.json\")")
        return load(self._improved)


class Linear(Answer):
    """x' = A x + B u (or x[k+1], with `dt` > 0), y = C x + D u; states, poles and margins in `data`."""

    def __init__(self, analysis):
        super().__init__(analysis.text, analysis.json, analysis.html)
        self.A, self.B, self.C, self.D, self.dt = analysis.A, analysis.B, analysis.C, analysis.D, analysis.dt
        self._delays = analysis.delays

    def to_control(self):
        """As a StateSpace of python-control. A system with delays has no such form."""
        if self._delays:
            raise ValueError("a continuous system with delays has no state space; sample it with sample_time=")
        import control
        return control.ss(self.A, self.B, self.C, self.D, self.dt)


class Sweep:
    """The results of a sweep: a table with a row for each run, and the runs that failed."""

    def __init__(self, answer, folder):
        self.table = Recording(answer.table)
        self.failures, self.missing, self.notes, self.folder = dict(answer.failures), answer.missing, answer.notes, folder
        self._answer = answer

    def __getitem__(self, name):
        return self.table[name]

    def report(self, path):
        _write(path, self._answer.html())

    def _repr_html_(self):
        return _frame(self._answer.html())

    def __repr__(self):
        return f"<loopwright.Sweep: {self.table.rows} runs, {len(self.failures)} failed, {self.missing} missing>"


class Diagram:
    """A diagram, loaded and compiled once. Runs of it share the plan."""

    def __init__(self, diagram):
        self._diagram = diagram

    @property
    def path(self):
        return self._diagram.path

    @property
    def title(self):
        return self._diagram.title

    @property
    def hash(self):
        return self._diagram.hash

    @property
    def parameters(self):
        """{path: value with unit}, as effective in the plan."""
        return self._diagram.parameters

    @property
    def warnings(self):
        return self._diagram.warnings

    @property
    def log(self):
        return self._diagram.log

    @property
    def ports(self):
        return self._diagram.ports

    def with_(self, set=None, variants=None):
        """The same file with further settings."""
        return load(self.path, dict(self._diagram.set) | dict(set or {}), self._diagram.variants | dict(variants or {}))

    def run(self, run=0, progress=None, check=True):
        """Simulates from start to stop. Each number `run` has other noise.

        A run that fails raises RunError, which holds the result; with check=False it is returned.
        `progress(time, stop)` is called now and then."""
        result = Run(self._diagram.run(run, progress))
        if check and result.status != "finished":
            raise RunError(result.message, result)
        return result

    def stepper(self, run=0):
        return Stepper(_core.Stepper(self._diagram, run))

    def linearize(self, *ports, **options):
        return linearize(self, *ports, **options)

    def __str__(self):
        return self._diagram.describe()

    def __repr__(self):
        return f"<loopwright.Diagram {self.path}: {self.title}>"

    def _repr_html_(self):
        return _frame(self._diagram.html())


def load(path, set=None, variants=None):
    """Loads a diagram: `set` and `variants` as --set and --variant, {"stage.payload": "0.2 kg"}.

    Raises InputError with every problem; `.problems` has file, line, column and hint of each."""
    settings = [(name, _setting(value)) for name, value in (set or {}).items()]
    return Diagram(_core.load(_os.fspath(path), settings, dict(variants or {})))


def _loaded(diagram):
    return diagram if isinstance(diagram, Diagram) else load(diagram)


def read(path, allow_not_finite=False):
    """A recording from a .csv or .mat file. A NaN is a gap and refused, unless it is allowed."""
    return Recording(_core.read(_os.fspath(path), allow_not_finite))


def _paths(experiments):
    """One path or several."""
    one = isinstance(experiments, (str, _os.PathLike))
    return [_os.fspath(e) for e in ([experiments] if one else experiments)]


def compare(diagram, experiments):
    """Holds a diagram against one recording or several, as `loopwright compare`."""
    answer = _core.compare(_loaded(diagram)._diagram, _paths(experiments))
    return Answer(answer.text, answer.json, answer.html)


def fit(diagram, experiments, parameters, iterations=40, of_each=(), hold_out=(), ranges=None, offsets=False):
    """Refines parameters so that the simulation meets one recording or several, as `loopwright fit`.
    `ranges`: {"mass": (80, 120)} in SI units."""
    return Fit(*_core.fit(_loaded(diagram)._diagram, _paths(experiments), list(parameters), iterations, list(of_each),
                          _paths(hold_out), dict(ranges or {}), offsets))


def diagnose(diagram, experiments, improved=None, all=False):
    """Finds the effect that a diagram lacks, as `loopwright diagnose`. `improved`: where to write the diagram with it;
    `all`: with the optional effects too."""
    improved = _os.fspath(improved) if improved else ""
    answer = _core.diagnose(_loaded(diagram)._diagram, _paths(experiments), improved, all)
    return Diagnosis(answer, improved)


def linearize(diagram, from_=(), to=(), open=(), break_at="", at=None, continuous=False, sample_time=0.0):
    """State space, poles, responses and margins between ports, as `loopwright linearize`."""
    def listed(ports):
        return [ports] if isinstance(ports, str) else list(ports)
    return Linear(_core.linearize(_loaded(diagram)._diagram, listed(from_), listed(to), listed(open), break_at, at,
                                  continuous, sample_time))


def sweep(path, output, threads=None, resume=False, progress=None):
    """Makes the runs of a sweep file on lanes and threads, as `loopwright sweep -o`. `progress(done, total)`."""
    answer = _core.sweep(_os.fspath(path), _os.fspath(output), threads or _os.cpu_count() or 1, resume, progress)
    return Sweep(answer, output)
