"""The pictures of the block reference: each is what its example gives today, small, and readable on its own."""
import pathlib
import re
import sys
import unittest
import xml.etree.ElementTree as xml

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs" / "images" / "blocks"
sys.path.insert(0, str(ROOT / "tools" / "reference"))
import pictures  # noqa: E402

REDRAW = "PYTHONPATH=build/release/lib/python /usr/bin/python3 tools/reference/pictures.py"
SVG = "{http://www.w3.org/2000/svg}"


class Pictures(unittest.TestCase):
    def test_files_are_what_the_examples_give(self):
        self.assertEqual({f.stem for f in FOLDER.glob("*.svg")}, set(pictures.PICTURES), REDRAW)
        for name, panels in pictures.PICTURES.items():
            text = (FOLDER / f"{name}.svg").read_text(encoding="utf-8")
            self.assertTrue(text == pictures.picture(name, panels), f"{name} has changed: {REDRAW}")
            self.assertLess(len(text), 40_000, name)

    def test_no_text_leaves_its_picture_or_covers_another(self):
        for name in pictures.PICTURES:
            picture = xml.parse(FOLDER / f"{name}.svg").getroot()
            width, height = float(picture.get("width")), float(picture.get("height"))
            boxes = []
            for text in picture.iter(SVG + "text"):
                long = 6.2 * len(text.text)  # [px] of 11 px letters without serifs, on average
                x = float(text.get("x")) - {"end": long, "middle": long / 2}.get(text.get("text-anchor"), 0)
                y = float(text.get("y"))
                self.assertTrue(x >= -1 and x + long <= width + 4 and 9 <= y <= height, f"{name}: {text.text}")
                boxes.append((x, x + long, y - 8, y, text.text))
            for i, a in enumerate(boxes):
                for b in boxes[:i]:
                    apart = a[1] <= b[0] or b[1] <= a[0] or a[3] <= b[2] or b[3] <= a[2]
                    self.assertTrue(apart, f"{name}: {a[4]} covers {b[4]}")

    def test_curves_stay_in_their_frames(self):
        for name in pictures.PICTURES:
            picture = xml.parse(FOLDER / f"{name}.svg").getroot()
            frames = [[float(r.get(k)) for k in ("x", "y", "width", "height")] for r in picture.iter(SVG + "rect")]
            for path in picture.iter(SVG + "path"):
                numbers = [float(n) for n in re.findall(r"[-\d.]+", path.get("d"))]
                self.assertTrue(any(all(x <= p <= x + w for p in numbers[::2]) and all(y <= p <= y + h for p in numbers[1::2])
                                    for x, y, w, h in frames), name)


if __name__ == "__main__":
    unittest.main()
