"""The competitor: FastAPI and NumPy, the lobe of (47) with the report's 100 terms. Raw doubles in and out."""

import sys

import numpy as np
import uvicorn
from fastapi import FastAPI, Request, Response

WAVELENGTH, HEIGHT, LENGTH, TERMS = 0.55, 0.2, 4.0, 100
WAVENUMBER = 2 * np.pi / WAVELENGTH

app = FastAPI()


def radiance(theta_i, theta_r, phi_r):
    """The specular lobe of a perfect conductor in many directions, all in one array at a time."""
    sin_i, cos_i = np.sin(theta_i), np.cos(theta_i)
    sin_r, cos_r = np.sin(theta_r), np.cos(theta_r)
    cos_phi = np.cos(phi_r)
    cos_sum = cos_i + cos_r
    facet = (1 + cos_i * cos_r - sin_i * sin_r * cos_phi) / cos_sum
    across = sin_i * sin_i + sin_r * sin_r - 2 * sin_i * sin_r * cos_phi
    x = (WAVENUMBER * LENGTH) ** 2 * across / 4
    g = (WAVENUMBER * HEIGHT * cos_sum) ** 2
    # g^m/(m! m) exp(-g - x/m), every step in place: new arrays would cost more than the arithmetic.
    weight = np.exp(-g) * g
    term = np.exp(-x)
    total = term * weight
    for m in range(2, TERMS + 1):
        # g^m/(m! m) from g^(m-1)/((m-1)! (m-1))
        weight *= g
        weight *= (m - 1) / (m * m)
        np.multiply(x, -1 / m, out=term)
        np.exp(term, out=term)
        term *= weight
        total += term
    total *= np.pi * (LENGTH / WAVELENGTH) ** 2 * facet * facet / cos_r
    return total


@app.post("/radiance")
async def answer(request: Request):
    angles = np.radians(np.frombuffer(await request.body(), dtype="<f8").reshape(3, -1))
    return Response(radiance(*angles).tobytes(), media_type="application/octet-stream")


if __name__ == "__main__":
    port = int(sys.argv[1])
    print(f"http://127.0.0.1:{port}/", flush=True)
    uvicorn.run(app, host="127.0.0.1", port=port, log_level="warning", access_log=False)
