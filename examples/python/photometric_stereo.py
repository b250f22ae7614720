"""Photometric stereo on image irradiance: a sphere under eight lamps, its normals found from its eight pictures.

The pictures are the service's, equation (51): matte plastic whose facets slope by 12°, through a lens. The textbook takes
all that a pixel receives for Lambertian, and the specular lobe leads it astray. The second attempt looks for the normal and the
albedo with which the service itself answers what the pixel received. What is left is the error of the arithmetic, and, from
pictures of 12 bits, that of the camera.
Usage: python photometric_stereo.py [FILE], photometric_stereo.png if none is named. The service is at REFLECTANCE_URL.
"""

import os
import sys

import httpx
import matplotlib.pyplot as plt
import numpy as np

URL = os.environ.get("REFLECTANCE_URL", "http://127.0.0.1:8080")
ALBEDO = 0.5
SURFACE = {"facet_slope_deg": 12, "medium": {"n": 1.5, "k": 0}, "diffuse_albedo": 1}
CAMERA = {"pixel_area_um2": 25, "distance_um": 1e6, "focal_length_um": 25e3, "aperture_um": 6e3}
VIEW = np.array([0.0, 0.0, 1.0])
STEP = 1e-5


def lamps(count=8, zenith=30):
    """Directions to lamps in a ring about the camera."""
    azimuths = 2 * np.pi * np.arange(count) / count
    side = np.sin(np.radians(zenith))
    up = np.full(count, np.cos(np.radians(zenith)))
    return np.stack([side * np.cos(azimuths), side * np.sin(azimuths), up], axis=1)


def sphere(pixels=41, steepest=55):
    """Where a sphere is seen at most so steeply, and its normals there."""
    x, y = np.meshgrid(*[np.linspace(-0.85, 0.85, pixels)] * 2)
    seen = np.hypot(x, y) < np.sin(np.radians(steepest))
    x, y = x[seen], y[seen]
    return seen, np.stack([x, y, np.sqrt(1 - x**2 - y**2)], axis=1)


def angles(normals, sources):
    """θ_i, θ_r, φ_r of every pixel under every lamp, each an array of pixels by lamps."""

    def degrees(sine_of, cosine):
        return np.degrees(np.arctan2(np.linalg.norm(sine_of, axis=-1), cosine))

    source, normal = sources[None, :, :], normals[:, None, :]
    theta_i = degrees(np.cross(normal, source), np.sum(normal * source, axis=-1))
    theta_r = degrees(np.cross(normal, VIEW), np.sum(normal * VIEW, axis=-1))
    # φ_r is 0 where the mirror direction is: on the other side of the normal than the source.
    forward = normal * np.sum(normal * source, axis=-1, keepdims=True) - source
    across = np.cross(normal, forward)
    phi_r = np.degrees(np.arctan2(across @ VIEW, forward @ VIEW))
    return theta_i, np.broadcast_to(theta_r, theta_i.shape), phi_r


def render(client, normals, sources):
    """What a white diffuse surface and its gloss send into each pixel: the two lobes apart, pixels by lamps."""
    theta_i, theta_r, phi_r = angles(normals, sources)
    request = {
        "model": "torrance_sparrow",
        "surface": SURFACE,
        "sensor": CAMERA,
        "geometry": {
            "theta_i_deg": theta_i.ravel().tolist(),
            "theta_r_deg": theta_r.ravel().tolist(),
            "phi_r_deg": phi_r.ravel().tolist(),
        },
        "components": ["diffuse_lobe", "specular_lobe"],
    }
    answer = client.post("/v1/image-irradiance", json=request)
    if answer.is_error:
        raise SystemExit(answer.text)
    columns = answer.json()
    return [np.reshape(columns[name], theta_i.shape) for name in ["diffuse_lobe", "specular_lobe"]]


def rounded(pictures, levels=2**12):
    """As a camera reads them that is saturated just beyond the brightest pixel."""
    step = pictures.max() / (levels - 1)
    return np.round(pictures / step) * step


def normalized(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def by_textbook(pictures, sources, white):
    """Normals and albedos of a Lambertian surface: least squares in three unknowns."""
    scaled = np.linalg.lstsq(sources, (pictures / white).T, rcond=None)[0].T
    albedos = np.linalg.norm(scaled, axis=1)
    return scaled / albedos[:, None], albedos


def tangents(normals):
    """Two directions across each normal."""
    first = normalized(np.cross(normals, [0.0, 1.0, 0.0]))
    return first, np.cross(normals, first)


def by_model(client, pictures, sources, normals, albedos):
    """The same by Gauss and Newton's method, from a first guess: each pixel for itself, all in one request."""
    for _ in range(12):
        first, second = tangents(normals)
        tilted = [normalized(normals + STEP * across) for across in (first, second)]
        # One request: the pixels as they are, and tilted either way.
        diffuse, gloss = render(client, np.concatenate([normals, *tilted]), sources)
        diffuse, gloss = (np.split(lobe, 3) for lobe in (diffuse, gloss))
        seen = [albedos[:, None] * d + g for d, g in zip(diffuse, gloss)]
        slopes = np.stack([(seen[1] - seen[0]) / STEP, (seen[2] - seen[0]) / STEP, diffuse[0]], axis=2)
        change = np.linalg.pinv(slopes) @ (pictures - seen[0])[:, :, None]
        # Far from the answer a full step may overshoot the lobe.
        tilt, lighter = np.clip(change[:, :2, 0], -0.1, 0.1), change[:, 2, 0]
        normals = normalized(normals + tilt[:, :1] * first + tilt[:, 1:] * second)
        albedos = albedos + lighter
        if np.abs(tilt).max() < 1e-12:
            break
    return normals, albedos


def errors(found, true):
    """Angles between, degrees."""
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(found, true), axis=1), np.sum(found * true, axis=1)))


def draw(file, seen, picture, attempts):
    """One of the pictures, and the errors of the attempts, each on a scale of its own."""

    def image(values):
        whole = np.full(seen.shape, np.nan)
        whole[seen] = values
        return whole

    page, (left, *others) = plt.subplots(1, 1 + len(attempts), figsize=(14, 3.6), layout="constrained")
    drawn = left.imshow(image(1e3 * picture), origin="lower", cmap="gray", vmin=0)
    left.set_title("under the first lamp", fontsize=10)
    page.colorbar(drawn, ax=left, shrink=0.8, label="image irradiance, mW m⁻²")
    for axes, (name, error) in zip(others, attempts.items()):
        drawn = axes.imshow(image(error), origin="lower", cmap="magma", vmin=0)
        axes.set_title(f"{name}:\nlargest error {error.max():.2g}°", fontsize=10)
        page.colorbar(drawn, ax=axes, shrink=0.8, label="error of the normal, degrees")
    for axes in (left, *others):
        axes.set_axis_off()
    page.savefig(file, dpi=150)


def main():
    file = sys.argv[1] if len(sys.argv) > 1 else "photometric_stereo.png"
    sources = lamps()
    seen, true = sphere()
    with httpx.Client(base_url=URL, timeout=60) as client:
        diffuse, gloss = render(client, true, sources)
        pictures = ALBEDO * diffuse + gloss
        # What a white surface sends that faces its lamp.
        (white,) = render(client, VIEW[None, :], VIEW[None, :])[0][0]
        textbook, albedos = by_textbook(pictures, sources, white)
        found = {
            "Lambertian": (textbook, albedos),
            "the service's model": by_model(client, pictures, sources, textbook, albedos),
            "the same, 12 bits": by_model(client, rounded(pictures), sources, textbook, albedos),
        }
    attempts = {name: errors(normals, true) for name, (normals, _) in found.items()}
    for name, error in attempts.items():
        albedos = found[name][1]
        print(
            f"{name}: {len(error)} normals, median error {np.median(error):.2g}°, largest {error.max():.2g}°; "
            f"albedo {ALBEDO}, found {albedos.min():.6g} to {albedos.max():.6g}"
        )
    draw(file, seen, pictures[:, 0], attempts)


if __name__ == "__main__":
    main()
