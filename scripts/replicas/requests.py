"""What is asked for: every resource whose answer follows from its request, in every format."""

import json

SCENE = {
    "model": "beckmann_spizzichino",
    "surface": {"rms_height_um": 0.2, "correlation_length_um": 4.0},
    "illumination": {"wavelength_um": 0.55},
}
GOLD = {
    "model": "torrance_sparrow",
    "surface": {"facet_slope_deg": 13, "medium": {"material": "Au"}, "diffuse_albedo": 0.1},
    "illumination": {"wavelength_um": [0.45, 0.55, 0.65]},
}
DIAGRAM = (
    "/v1/diagrams?model=beckmann_spizzichino&rms_height_um=0.001&correlation_length_um=0.01&wavelength_um=0.001"
    "&components=specular_lobe&sweep=theta_i_deg&from_deg=-80&to_deg=80&points=161&at_deg=45"
)
COLUMNS = "/v1/brdf?model=torrance_sparrow&facet_slope_deg=9"


def directions(count):
    return {"theta_i_deg": 30, "theta_r_deg": [80 * index / count for index in range(count)]}


def post(path, scene, count=1, accept="application/json", **members):
    body = json.dumps(scene | {"geometry": directions(count)} | members)
    return ("POST", path, {"content-type": "application/json", "accept": accept}, body.encode())


def get(path, accept="application/json"):
    return ("GET", path, {"accept": accept}, None)


JSON = {"content-type": "application/json"}
ARROW = "application/vnd.apache.arrow.stream"
CSV = b"theta_i_deg,theta_r_deg\r\n" + b"".join(b"%d,%d\r\n" % (index % 89, index % 71) for index in range(200))
LINEAR = {"model": "fixed_view", "K_dl": 1, "K_sl": 2, "K_ss": 3, "facet_slope_deg": 5, "spike": "delta"}

# Requests that the balancer can keep whole, and answers that leave in one piece: these survive a replica that is killed.
SMALL = [
    post("/v1/radiance", SCENE),
    post("/v1/radiance", SCENE, 100),
    post("/v1/radiance", SCENE, 100, output={"log10": True}),
    post("/v1/radiance", SCENE, 300, accept=ARROW),
    post("/v1/radiance", SCENE, 300, accept="application/x-npy"),
    post("/v1/brdf", GOLD, 50),
    post("/v1/plan", SCENE, 20),
    post("/v1/image-irradiance", LINEAR, 10),
    ("POST", COLUMNS, {"content-type": "text/csv", "accept": "text/csv"}, CSV),
    get("/v1/roughness?rms_height_um=0.0003&correlation_length_um=0.01"),
    get(DIAGRAM),
    get(DIAGRAM, "text/csv"),
    get(DIAGRAM, ARROW),
    ("POST", "/v1/albedo", JSON, json.dumps(SCENE | {"theta_i_deg": [30, 60]}).encode()),
]
# Sent in pieces, the longest while they are made: what has left cannot be taken back, so these are not asked for while
# one is killed. One that is told to stop finishes them.
LARGE = [
    post("/v1/radiance", SCENE, 900, output={"log10": True}),
    get("/openapi.json"),
    get("/v1/materials"),
    post("/v1/radiance", SCENE, 2000),
    post("/v1/radiance", SCENE, 2000, accept="text/csv"),
    get(DIAGRAM.replace("points=161", "points=40000"), "text/csv"),
    get("/v1/figures/23c"),
]
