#!/bin/sh
# Everything that is wrong with a request comes back at once, each with its place and what would have been accepted.
set -eu
url=${REFLECTANCE_URL:-http://127.0.0.1:8080}

curl --silent --show-error --write-out '\nstatus %{http_code}\n' "$url/v1/radiance" --json '{
  "model": "torrance_sparow",
  "surface": {"facet_slope_deg": -3, "medium": {"n": 1.5, "k": 0, "m": 2}},
  "geometry": {"theta_i_deg": 91, "theta_r_deg": [0, 95]}}'
