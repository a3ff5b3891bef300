"""The thresholds as variables, and the table of the sensitivity run."""

import pathlib
import re
import sys
import unittest

import sensitivity
import variable_criteria

FILE = pathlib.Path(sys.argv[1])
CRITERIA = variable_criteria.criteria(FILE)


class Variables(unittest.TestCase):
    def test_every_constant_becomes_a_variable_of_the_table(self):
        found = variable_criteria.thresholds(CRITERIA)
        code = re.sub(r"///?.*", "", CRITERIA)
        self.assertEqual(len(found), len(re.findall(r"\w+(?:\[\])? = ", code)))
        text = variable_criteria.variable(CRITERIA)
        self.assertNotIn("constexpr", text)
        for _, name, _, _ in found:
            self.assertIn(f'{{"{name}", ', text)

    def test_each_type_has_its_place(self):
        text = variable_criteria.variable("#include <cstddef>\nconstexpr double a = 1e-3, b = 2.0 / 3;\nconstexpr int c = 3;\n"
                                          "constexpr size_t d = 4;\nconstexpr double e[] = {1, 2};\n}  // namespace x\n")
        for line in ('{"a", {&a, 1}},', '{"b", {&b, 1}},', '{"c", {}, &c},', '{"d", {}, nullptr, &d},', '{"e", e},',
                     "inline double a = 1e-3, b = 2.0 / 3;", "inline double e[] = {1, 2};"):
            self.assertIn(line, text)

    def test_those_of_diagrams_without_roles_are_left_out(self):
        names = [name for name, _ in sensitivity.thresholds(FILE)]
        self.assertIn("judged_row_s", names)
        self.assertIn("speed_span_s", names)
        self.assertNotIn("alike_responses", names)

    def test_those_of_diagrams_without_roles_are_the_others(self):
        all_names = {name for _, name, _, _ in variable_criteria.thresholds(CRITERIA)}
        with_roles, without = ({n for n, _ in sensitivity.thresholds(FILE, w)} for w in (False, True))
        self.assertEqual(with_roles | without, all_names)
        self.assertFalse(with_roles & without)


class Table(unittest.TestCase):
    def test_says_what_became_of_the_answers(self):
        before = [("exact", "explained: a"), ("declared", "explained: b or c"), ("flagged", "unexplained: no effect")]
        self.assertEqual(sensitivity.cell(before, before), "=")
        self.assertEqual(sensitivity.cell(before, [("silent", "explained: b"), before[1], ("exact", "explained: a")]), "1 silent, 1 right")
        self.assertEqual(sensitivity.cell(before, [before[0], ("declared", "explained: b or d"), before[2]]), "1 said otherwise")

    def test_names_what_changes_nothing(self):
        same = [("exact", "explained: a")]
        results = {sensitivity.NONE: same, ("x", 0.5): same, ("x", 1.5): same, ("y", 0.5): [("silent", "explained: b")], ("y", 1.5): same}
        text = re.sub(" +", " ", sensitivity.table([("x", "1"), ("y", "2")], results))
        self.assertIn("No answer changes with `x`.", text)
        self.assertIn("| `y` | 2 | 1 silent | = |", text)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
