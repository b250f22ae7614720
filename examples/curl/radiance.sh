#!/bin/sh
# One scene by curl: the radiance towards a few viewers, and by its logarithm where no double can hold it.
set -eu
url=${REFLECTANCE_URL:-http://127.0.0.1:8080}

echo "Radiance of a rough metal, with the bound of its error:"
curl --fail-with-body --silent --show-error "$url/v1/radiance" --json '{
  "model": "beckmann_spizzichino",
  "surface": {"rms_height_um": 0.2, "correlation_length_um": 4.0},
  "illumination": {"wavelength_um": 0.55},
  "geometry": {"theta_i_deg": 30, "theta_r_deg": [15, 30, 45]},
  "components": ["specular_lobe"]}'

printf '\n\nThe same, a thousand times rougher and seen far from the mirror direction:\n'
curl --fail-with-body --silent --show-error "$url/v1/radiance" --json '{
  "model": "beckmann_spizzichino",
  "surface": {"rms_height_um": 200, "correlation_length_um": 8000},
  "illumination": {"wavelength_um": 0.55},
  "geometry": {"theta_i_deg": 30, "theta_r_deg": -89},
  "components": ["specular_lobe"],
  "output": {"log10": true}}'
echo
