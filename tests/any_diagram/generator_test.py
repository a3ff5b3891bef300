"""The plants of the benchmark, against what their equations must satisfy."""

import dataclasses
import json
import math
import pathlib
import random
import tempfile
import unittest

import scenario
import simulate
from laws import LAWS


class Generator(unittest.TestCase):
    def test_every_plant_has_a_diagram_for_its_ports_and_places(self):
        for make in scenario.PLANTS:
            plant = make()
            with self.subTest(plant=plant.kind):
                self.assertEqual(len(plant.initial), len(plant.rate(list(plant.initial), [0.0] * len(plant.drives),
                                                                    {n: v for n, (v, _) in plant.parameters.items()}, lambda port, value: value)))
                for place in plant.places:
                    self.assertIn(place.site.split(".")[0], plant.blocks)
                    self.assertIn(place.law, LAWS)
                for port, _, _ in plant.outputs:
                    self.assertIn(port.split(".")[0], plant.blocks)

    def test_all_ports_of_places_and_noise_are_in_the_equations(self):
        for make in scenario.PLANTS:
            plant, seen = make(), set()
            p = {n: v for n, (v, _) in plant.parameters.items()}
            plant.rate(list(plant.initial), [0.1] * len(plant.drives), p, lambda port, value: (seen.add(port), value)[1])
            self.assertLessEqual({place.site for place in plant.places} | set(plant.noise), seen, plant.kind)

    def test_what_is_hidden_gains_and_a_law_that_parameters_replace_does_not(self):
        plant = next(make() for make in scenario.PLANTS if make.__name__ == "duffing")
        p = {n: v for n, (v, _) in plant.parameters.items()}
        cube = simulate.Hidden(next(q for q in plant.places if q.law == "cube"), 0.0, -5e8)
        record = simulate.run(plant, p, [cube], plant.drive(random.Random(1)), random.Random(2), {"net.sum": 0.05}, (1e-7,))
        short = simulate.Record(record.u[:400], record.y[:400], record.x[:400], record.sites)
        filter_ = simulate.Filter(plant, p, [cube], short, {"net.sum": 0.05}, (1e-7,))
        gain, of_mass = simulate.gains(filter_, p, [cube], {"mass": 0.2}, list(p), 400)
        self.assertGreater(gain, scenario.LEAST_GAIN)
        self.assertGreater(of_mass, scenario.LEAST_GAIN)

    def test_a_hysteresis_reaches_its_size_within_the_motion(self):
        speeds = [math.cos(2 * math.pi * k / 100) for k in range(1000)]  # 1 m/s over 100 samples of 5 ms
        self.assertAlmostEqual(scenario.displacement(speeds, 5e-3), 0.5 / (2 * math.pi) / math.sqrt(2), delta=1e-4)

    def test_a_function_without_a_name_hides_with_nothing_that_it_contains(self):
        for make in scenario.PLANTS:
            for draw in range(200):
                unnamed, *others = scenario.chosen_places(make(), "outside", random.Random(draw))
                if LAWS[unnamed.law].shapes:  # nothing of this plant is outside the catalogue
                    continue
                for other in others:
                    at_the_same_port = other.site == unnamed.site
                    self.assertFalse(at_the_same_port and (other.law == "constant" or other.names == unnamed.names), (unnamed, other))

    def test_dry_friction_changes_its_side_as_finely_as_its_width_asks_for(self):
        plant = next(make() for make in scenario.PLANTS if make.__name__ == "hysteretic")
        p = {n: v for n, (v, _) in plant.parameters.items()}
        place = next(q for q in plant.places if q.law == "sign")
        friction, motions = simulate.Hidden(place, 2e-3, -30.0), []
        for substeps in (plant.substeps, 64 * plant.substeps):
            finer = dataclasses.replace(plant, substeps=substeps, rows=300)
            motions.append(simulate.run(finer, p, [friction], plant.drive(random.Random(1)), None))
        coarse, fine = ([x[0] for x in motion.x] for motion in motions)
        error = math.sqrt(sum((a - b) ** 2 for a, b in zip(coarse, fine)) / len(fine))
        self.assertLess(error, 1e-4 * math.sqrt(sum(b * b for b in fine) / len(fine)))

    def test_a_dead_zone_that_is_never_entered_is_a_constant(self):
        plant = next(make() for make in scenario.PLANTS if make.__name__ == "tanks")
        place = next(q for q in plant.places if q.law == "dead_zone")
        for least, names in ((1.5, {("balance1.sum", "constant", ""), ("pump.u", "constant", "")}), (0.5, set()), (-2.0, set())):
            record = simulate.Record([], [], [], {"pump.u": [least, 3.0, 2.0]})
            self.assertEqual(set(scenario.constants_beside_zero(plant, simulate.Hidden(place, 0.9, 1.0), record)), names)

    def test_a_motion_that_runs_away_within_a_step_is_drawn_again(self):
        with tempfile.TemporaryDirectory() as folder:
            scenario.generate(900460, folder)  # whose first draw has a cube that pushes
        with tempfile.TemporaryDirectory() as folder:
            scenario.generate(900820, folder)  # whose first draw does so where the filter begins

    def test_a_seed_always_gives_the_same_files(self):
        texts = []
        for _ in range(2):
            with tempfile.TemporaryDirectory() as name:
                truth = scenario.generate(120_065, name)
                folder = pathlib.Path(name)
                texts.append([(folder / f).read_text() for f in ("record.csv", "diagram.json", "record.experiment.json", "truth.json")])
                self.assertEqual(json.loads(texts[-1][3])["seed"], truth["seed"])
        self.assertEqual(texts[0], texts[1])


if __name__ == "__main__":
    unittest.main()
