#!/bin/sh
# Directions as columns of a CSV file, the scene in the query; the answer as a NumPy array in radiance.npy, or in the
# file that is named.
set -eu
url=${REFLECTANCE_URL:-http://127.0.0.1:8080}
file=${1:-radiance.npy}

seq 0 89 | awk 'BEGIN { print "theta_i_deg,theta_r_deg,phi_r_deg" } { print 30 "," $1 "," 2 * $1 }' |
    curl --fail-with-body --silent --show-error --output "$file" \
        --header 'content-type: text/csv' --header 'accept: application/x-npy' --data-binary @- \
        "$url/v1/radiance?model=torrance_sparrow&facet_slope_deg=9&diffuse_albedo=0.2"
echo "$file: $(wc -c <"$file") bytes"
