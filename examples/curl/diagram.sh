#!/bin/sh
# A diagram is a link: the same one as CSV, and once more with its entity tag, when nothing has to be sent.
set -eu
url=${REFLECTANCE_URL:-http://127.0.0.1:8080}
link="$url/v1/diagrams?model=torrance_sparrow&facet_slope_deg=9&components=specular_lobe&sweep=theta_r_deg&from_deg=-80&to_deg=80&step_deg=20&at_deg=30,60"

echo "As CSV:"
curl --fail-with-body --silent --show-error --header 'accept: text/csv' "$link"

tag=$(curl --fail-with-body --silent --show-error --output /dev/null --write-out '%header{etag}' "$link")
again=$(curl --silent --show-error --output /dev/null --write-out '%{http_code}' --header "if-none-match: $tag" "$link")
echo "Asked again with its tag $tag: status $again"
