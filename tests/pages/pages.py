#!/usr/bin/env python3
"""Makes report pages of every kind with the program and looks at them in chromium (look.mjs).

  pages.py --build BUILD [--few] [--pictures FOLDER]

--few: a page of most kinds at two widths. Without it: the pages of all shipped diagrams that run by themselves, at all
widths, also with open subdiagrams. Kinds that need measured data are made where $LOOPWRIGHT_DATA has it.
"""
import argparse
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
SKIPPED = 77  # ctest shows the test as not run


class Pages:
    def __init__(self, program, folder):
        self.program, self.folder, self.made, self.failed = program, folder, [], []

    def command(self, *words):
        done = subprocess.run([self.program, *map(str, words)], cwd=SOURCE, capture_output=True, text=True, timeout=900)
        return done.returncode, done.stderr

    def page(self, name, *words, option='--report'):
        """A page of a command that may say that a run failed (1), but not that its input was wrong (2)."""
        path = self.folder / f'{name}.html'
        code, errors = self.command(*words, option, path)
        if path.exists():
            self.made.append(path)
        if code not in (0, 1) or not path.exists():
            self.failed.append(f'{name}: exit code {code}: {errors.strip()[:300]}')
        return path


def runs_alone(path):
    """Whether a file is a diagram with a stop time, and without inputs: not a part of others."""
    try:
        text = json.loads(path.read_text())
    except ValueError:
        return False
    return 'blocks' in text and 'stop' in text.get('solver', {}) and not text.get('inputs')


def name_of(path):
    return str(path.relative_to(SOURCE / 'diagrams').with_suffix('')).replace('/', '_')


def make_run(pages, diagram, *more):
    return pages.page('run_' + name_of(diagram), 'run', diagram, '-q', *more)


def diagnosed_cart(pages):
    """A cart whose spring the diagram lacks: a diagnosis without roles."""
    def quantity(value, unit):
        return {'value': value, 'unit': unit}

    blocks = {
        'source': {'type': 'Multisine', 'band': {'from': 0.2, 'to': 8, 'count': 12, 'amplitude': quantity(1.5, 'N')}},
        'push': {'type': 'Gain', 'gain': 1, 'in': {'u': 'source.y'}},
        'viscous': {'type': 'ViscousFriction', 'damping': '=damping', 'in': {'velocity': 'cart.velocity'}},
        'forces': {'type': 'Sum', 'signs': '+-', 'in': {'terms': ['push.y', 'viscous.force']}},
        'cart': {'type': 'Mass', 'mass': '=mass', 'in': {'force': 'forces.sum'}}}
    nominal = {'loopwright': 1, 'title': 'A cart', 'solver': {'method': 'rk4', 'step': 0.0005, 'stop': 6, 'record_step': 0.002},
               'parameters': {'damping': quantity(3, 'N*s/m'), 'mass': quantity(1.2, 'kg')}, 'blocks': blocks}
    plant = nominal | {'parameters': nominal['parameters'] | {'stiffness': quantity(2000, 'N/m^3')}, 'blocks': blocks | {
        'hum': {'type': 'Noise', 'standard_deviation': quantity(0.05, 'N'), 'sample_time': 0.002},
        'hardening': {'type': 'Expression', 'formula': 'stiffness*x^3', 'names': ['x'], 'in': {'arguments': ['cart.position']}},
        'forces': {'type': 'Sum', 'signs': '++--', 'in': {'terms': ['push.y', 'hum.y', 'viscous.force', 'hardening.y']}}}}
    experiment = {'loopwright': 1, 'title': 'A cart', 'data': 'cart.csv', 'time': 'time', 'hold_out': {'fraction': 0.25},
                  'drive': {'push.u': {'column': 'source.y', 'unit': 'N', 'interpolation': 'linear'}},
                  'compare': {'cart.position': {'column': 'cart.position', 'unit': 'm'}}}
    for name, content in ('plant', plant), ('nominal', nominal), ('cart.experiment', experiment):
        (pages.folder / f'{name}.json').write_text(json.dumps(content))
    pages.command('run', pages.folder / 'plant.json', '-q', '-o', pages.folder / 'cart.csv')
    pages.page('any_diagram', 'diagnose', pages.folder / 'nominal.json', pages.folder / 'cart.experiment.json')


def make_few(pages):
    motor = SOURCE / 'diagrams/linear_motor'
    first, second = pages.folder / 'first.csv', pages.folder / 'second.csv'
    pages.command('run', motor / 'conventional.json', '-q', '-o', first)
    pages.command('run', motor / 'conventional.json', '-q', '-o', second, '--set', 'payload=0.2621 kg')
    make_run(pages, motor / 'conventional.json', '--beside', second)
    make_run(pages, SOURCE / 'diagrams/tutorial/homing.json')  # with the chart of a state machine
    pages.page('report', 'report', first, second, option='-o')
    pages.page('look', 'look', first)
    pages.page('linearize', 'linearize', motor / 'conventional.json', '--from', 'stage.command', '--to', 'stage.position',
               '--break', 'stage.command')
    diagnosed_cart(pages)
    if os.environ.get('LOOPWRIGHT_DATA'):
        emps = SOURCE / 'diagrams/emps'
        pages.page('compare', 'compare', emps / 'nominal.json', emps / 'closed_loop.experiment.json')


def make_all(pages):
    make_few(pages)
    for diagram in sorted((SOURCE / 'diagrams').rglob('*.json')):
        if runs_alone(diagram) and diagram.name not in ('conventional.json', 'homing.json'):
            make_run(pages, diagram)
    motor, emps = SOURCE / 'diagrams/linear_motor', SOURCE / 'diagrams/emps'
    pages.page('stability', 'stability', motor / 'ps.json', '--no-kicks')
    recording = SOURCE / 'build/paper/identification_0.csv'  # which the training file names
    if not recording.exists():
        recording.parent.mkdir(parents=True, exist_ok=True)
        pages.command('run', motor / 'identification.json', '--run', '0', '-q', '-o', recording)
    pages.page('gp', 'gp', 'train', motor / 'ps.training.json', '--model', pages.folder / 'ps.model.json')
    sweep = pages.folder / 'sweep'
    pages.command('sweep', motor / 'controllers.sweep.json', '-o', sweep)
    pages.command('sweep', 'report', sweep)
    if (sweep / 'report.html').exists():
        pages.made.append(sweep / 'report.html')
    if os.environ.get('LOOPWRIGHT_DATA'):
        pages.page('fit', 'fit', emps / 'published.json', emps / 'closed_loop.experiment.json',
                   '--parameters', 'mass,damping,coulomb,offset')
        pages.page('diagnose', 'diagnose', emps / 'nominal.json', emps / 'open_loop.experiment.json')


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--build', required=True)
    parser.add_argument('--few', action='store_true')
    parser.add_argument('--pictures')
    options = parser.parse_args()
    for program in ('node', 'chromium'):
        if not shutil.which(program):
            print(f'{program} is not installed: pages were not looked at')
            return SKIPPED
    if not (HERE / 'node_modules/playwright-core').exists():
        print('playwright-core is not installed: run tools/setup.sh')
        return 1
    folder = Path(options.build).resolve() / 'pages'
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    pages = Pages(Path(options.build).resolve() / 'bin/loopwright', folder)
    (make_few if options.few else make_all)(pages)
    for failure in pages.failed:
        print(failure)
    words = ['--widths', '1280,400'] if options.few else ['--open']
    if options.pictures:
        words += ['--pictures', str(Path(options.pictures).resolve())]
    seen = subprocess.run(['node', str(HERE / 'look.mjs'), *words, *map(str, pages.made)]).returncode
    return 1 if seen or pages.failed else 0


if __name__ == '__main__':
    sys.exit(main())
