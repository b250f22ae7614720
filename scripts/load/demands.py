"""The requests that are measured."""

import subprocess
from functools import cache
from urllib.parse import urlencode

from client import ARROW, CSV, JSON, NPY, request
from process import RELEASE, WORK

ONE = (
    b'{"model":"beckmann_spizzichino","surface":{"rms_height_um":0.2,"correlation_length_um":4.0},'
    b'"illumination":{"wavelength_um":0.55},"geometry":{"theta_i_deg":30,"theta_r_deg":45},'
    b'"components":["specular_lobe"]}'
)

# The same scene where the body holds columns only.
SCENE = {
    "model": "beckmann_spizzichino",
    "rms_height_um": 0.2,
    "correlation_length_um": 4.0,
    "wavelength_um": 0.55,
    "components": "specular_lobe",
}

MEDIA = {"json": JSON, "short.json": JSON, "arrow": ARROW, "npy": NPY, "csv": CSV}
BODIES = WORK / "bodies"


# What most clients send of themselves, with every small request; the bare server gets it too.
USUAL = {"user_agent": "load", "accept": "*/*", "accept_encoding": "gzip, deflate, br, zstd"}


def one():
    """One direction."""
    return request("POST", "/v1/radiance", ONE, content_type=JSON, **USUAL)


def hello():
    """What the bare server is asked."""
    return request("GET", "/", **USUAL)


@cache
def body(count, end):
    """A batch as `floors` writes it."""
    if not (BODIES / f"{count}.{end}").exists():
        subprocess.run([RELEASE / "examples" / "floors", "bodies", BODIES, str(count)], check=True)
    return (BODIES / f"{count}.{end}").read_bytes()


def batch(count, end):
    """So many directions in and out in one format."""
    medium = MEDIA[end]
    query = "" if medium == JSON else "?" + urlencode(SCENE)
    return request("POST", "/v1/radiance" + query, body(count, end), content_type=medium, accept=medium)


def diagram(rows, accept, **headers):
    """A diagram of so many rows as a link."""
    curves = max(1, rows // 1_000_000)
    sweep = {
        **SCENE,
        "sweep": "theta_r_deg",
        "from_deg": -80,
        "to_deg": 80,
        "points": rows // curves,
        "at_deg": ",".join(str(10 + 5 * curve) for curve in range(curves)),
    }
    return request("GET", "/v1/diagrams?" + urlencode(sweep), accept=accept, **headers)
