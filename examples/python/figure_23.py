"""Draws the report's figure 23 from the service: specular lobes over the source angle, for fixed views.

Left the Beckmann-Spizzichino model, right the Torrance-Sparrow model of the same roughness by (79).
Usage: python figure_23.py [FILE], figure_23.png if none is named. The service is at REFLECTANCE_URL.
"""

import os
import re
import sys

import httpx
import matplotlib.pyplot as plt
from matplotlib.patheffects import withStroke

URL = os.environ.get("REFLECTANCE_URL", "http://127.0.0.1:8080")


def typeset(text):
    """Indices and exponents where they belong: σ_h, m^-2."""
    text = re.sub("σ_(.)", lambda found: f"$\\sigma_{{{found[1].replace('α', chr(92) + 'alpha')}}}$", text)
    return re.sub(r"\^(-?\d+)", r"$^{\1}$", text)


def panel(axes, figure):
    """One of the six: a curve for each view."""
    (shown,) = figure["panels"]
    diagram = shown["diagram"]
    angles = diagram["axis"]["values"]
    highest = 0
    for series in diagram["series"]:
        # A value that is infinite or undefined is null.
        values = [float("nan") if value is None else value for value in series["total"]]
        (line,) = axes.plot(angles, values)
        peak = max(values)
        highest = max(highest, peak)
        axes.annotate(
            f"{series['at_deg']:g}°",
            (angles[values.index(peak)], peak),
            textcoords="offset points",
            xytext=(0, 3),
            ha="center",
            color=line.get_color(),
            fontsize=8,
            # Legible where another curve passes.
            path_effects=[withStroke(linewidth=3, foreground="white")],
        )
    axes.set_title(f"{figure['id']}  {shown['label']}\n{typeset(figure['parameters'])}", fontsize=8.5)
    axes.set_xlim(-90, 90)
    axes.set_xticks(range(-90, 91, 30))
    axes.set_ylim(0, 1.14 * highest)
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(labelsize=8)
    axes.grid(alpha=0.25)
    return len(diagram["series"]), typeset(diagram["unit"])


def main():
    file = sys.argv[1] if len(sys.argv) > 1 else "figure_23.png"
    picture, rows = plt.subplots(3, 2, figsize=(9, 9.5), sharex=True, layout="constrained")
    with httpx.Client(base_url=URL) as client:
        for axes, letter in zip(rows.flat, "abcdef"):
            answer = client.get(f"/v1/figures/23{letter}")
            answer.raise_for_status()
            views, unit = panel(axes, answer.json())
    for axes in rows[-1]:
        axes.set_xlabel("source angle θᵢ, degrees")
    for axes in rows[:, 0]:
        axes.set_ylabel(f"radiance, {unit}", fontsize=8.5)
    title = "Surface Reflection, figure 23: the specular lobe over the source angle,\neach curve for the view θᵣ that stands at its peak"
    picture.suptitle(title, fontsize=11)
    picture.savefig(file, dpi=150)
    print(f"{file}: six panels of {views} views")


if __name__ == "__main__":
    main()
