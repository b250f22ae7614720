"""Every program in examples/ is run as a reader would run it, against the running service."""

import re
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def run(*command):
    """What a program says. It has to succeed, and to complain of nothing."""
    ended = subprocess.run([str(part) for part in command], capture_output=True, text=True, timeout=120)
    if ended.returncode or ended.stderr:
        raise AssertionError(f"{command}: exit code {ended.returncode}\n{ended.stdout}\n{ended.stderr}")
    return ended.stdout


def picture_size(file):
    """Width and height of a PNG."""
    head = file.read_bytes()[:24]
    if head[:8] != b"\x89PNG\r\n\x1a\n":
        raise AssertionError(f"{file} is no PNG")
    return struct.unpack(">II", head[16:])


class Curl(unittest.TestCase):
    def test_radiance(self):
        text = run(EXAMPLES / "curl/radiance.sh")
        self.assertIn('"total":[1.4278645300939727,9.870528376282403,1.9158949680966844]', text)
        self.assertIn('"log10_total":[-496.15544660340066]', text)

    def test_diagram(self):
        text = run(EXAMPLES / "curl/diagram.sh")
        self.assertEqual(text.count("\n30.0,"), 9)
        self.assertRegex(text, r'its tag "[0-9a-f]{16}": status 304')

    def test_columns(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "radiance.npy"
            run(EXAMPLES / "curl/columns.sh", file)
            self.assertEqual(file.read_bytes()[:6], b"\x93NUMPY")

    def test_mistakes(self):
        text = run(EXAMPLES / "curl/mistakes.sh")
        self.assertIn("status 422", text)
        self.assertEqual(text.count('"pointer"'), 5)


class Python(unittest.TestCase):
    def draw(self, name):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "picture.png"
            text = run(sys.executable, EXAMPLES / "python" / name, file)
            self.assertGreater(min(picture_size(file)), 500)
        return text

    def test_figure_23(self):
        self.assertIn("six panels of 4 views", self.draw("figure_23.py"))

    def test_photometric_stereo(self):
        text = self.draw("photometric_stereo.py")
        largest = [float(number) for number in re.findall(r"largest ([^°]+)°", text)]
        lambertian, model, from_12_bits = largest
        self.assertGreater(lambertian, 5)
        self.assertLess(model, 1e-12)
        self.assertLess(from_12_bits, 0.03)


class JavaScript(unittest.TestCase):
    def test_spike(self):
        text = run("node", EXAMPLES / "javascript/spike.mjs")
        self.assertEqual(len(text.splitlines()), 14)
        self.assertIn("From 0.05 wavelengths on the lobe is the brighter one.", text)

    def test_stream(self):
        text = run("node", EXAMPLES / "javascript/stream.mjs")
        self.assertIn("source at 30°: brightest at 30.64°", text)
        self.assertIn("200000 of 300000 rows read", text)


if __name__ == "__main__":
    unittest.main()
