"""The client that openapi-python-client makes of the document, against the running service.

The types are checked as well: mypy reads this file with the generated package.
"""

import math
import os
import unittest
from http import HTTPStatus

from reflectance_client import AuthenticatedClient
from reflectance_client.api.diagrams import diagram, figure
from reflectance_client.api.reflection import image_irradiance, plan, radiance
from reflectance_client.api.roughness import roughness
from reflectance_client.models import (
    Answer,
    Diagram,
    DiagramRequest,
    DiagramRequestModel,
    DiagramRequestSweep,
    FigureAnswer,
    FixedView,
    FixedViewModel,
    FixedViewSpikeType0,
    Geometry,
    Illumination,
    LinearAnswer,
    LookedUp,
    Output,
    Plan,
    Problem,
    RadianceRequest,
    RadianceRequestModel,
    RefractiveIndex,
    Roughness,
    SpectrumAnswer,
    Surface,
)
from reflectance_client.types import Unset

CLIENT = AuthenticatedClient(
    base_url=os.environ["REFLECTANCE_URL"],
    token=os.environ["REFLECTANCE_KEY"],
    raise_on_unexpected_status=True,
)
ROUGH = Surface(rms_height_um=0.2, correlation_length_um=4.0)
GREEN = Illumination(wavelength_um=0.55)


def scene(
    theta_r_deg: float | list[float], surface: Surface = ROUGH, output: Output | None = None
) -> RadianceRequest:
    return RadianceRequest(
        model=RadianceRequestModel.BECKMANN_SPIZZICHINO,
        surface=surface,
        illumination=GREEN,
        geometry=Geometry(theta_i_deg=30, theta_r_deg=theta_r_deg),
        output=output,
    )


class Generated(unittest.TestCase):
    def test_radiance(self) -> None:
        answer = radiance.sync(client=CLIENT, body=scene([0, 30, 45], output=Output(log10=True, per_direction=True)))
        assert isinstance(answer, Answer)
        self.assertEqual(answer.unit, "W m^-2 sr^-1")
        self.assertEqual(answer.total[1:], [9.870528376282403, 1.9158949680966844])
        self.assertEqual([omitted.component for omitted in answer.omitted], ["specular_spike"])
        assert not isinstance(answer.log10_total, Unset)
        for value, log10 in zip(answer.total, answer.log10_total):
            assert value is not None and log10 is not None
            self.assertAlmostEqual(math.log10(value), log10, places=12)

    def test_radiance_at_several_wavelengths(self) -> None:
        request = scene(45, Surface(rms_height_um=0.2, correlation_length_um=4.0, medium=RefractiveIndex(n=0.3, k=2.6)))
        request.illumination = Illumination(wavelength_um=[0.45, 0.55])
        answer = radiance.sync(client=CLIENT, body=request)
        assert isinstance(answer, SpectrumAnswer)
        self.assertEqual([line.wavelength_um for line in answer.spectrum], [0.45, 0.55])
        for line in answer.spectrum:
            assert isinstance(line.medium, LookedUp | Unset)

    def test_roughness(self) -> None:
        answer = roughness.sync(client=CLIENT, rms_height_um=0.0003, correlation_length_um=0.01)
        assert isinstance(answer, Roughness)
        self.assertEqual(answer.facet_slope_deg, 2.4279433133767867)

    def test_diagram(self) -> None:
        request = DiagramRequest(
            model=DiagramRequestModel.TORRANCE_SPARROW,
            surface=Surface(facet_slope_deg=9),
            sweep=DiagramRequestSweep.THETA_R_DEG,
            from_deg=-80,
            to_deg=80,
            points=81,
            at_deg=[30, 60],
        )
        answer = diagram.sync(client=CLIENT, body=request)
        assert isinstance(answer, Diagram)
        self.assertEqual([series.at_deg for series in answer.series], [30, 60])
        self.assertEqual(len(answer.axis.values), 81)
        for series in answer.series:
            assert not isinstance(series.total, Unset)
            self.assertEqual(len(series.total), 81)

    def test_figure(self) -> None:
        answer = figure.sync(client=CLIENT, id="23a")
        assert isinstance(answer, FigureAnswer)
        (panel,) = answer.panels
        self.assertEqual(panel.diagram.axis.name, "theta_i_deg")

    def test_plan(self) -> None:
        answer = plan.sync(client=CLIENT, body=scene(30))
        assert isinstance(answer, Plan)
        self.assertEqual(answer.directions, 1)

    def test_image_irradiance(self) -> None:
        request = FixedView(
            model=FixedViewModel.FIXED_VIEW,
            k_dl=1,
            k_sl=2,
            k_ss=3,
            facet_slope_deg=5,
            spike=FixedViewSpikeType0.DELTA,
            geometry=Geometry(theta_i_deg=60, theta_r_deg=60),
        )
        answer = image_irradiance.sync(client=CLIENT, body=request)
        assert isinstance(answer, LinearAnswer)
        self.assertEqual((answer.total, answer.delta_on), ([2.5], [True]))

    def test_mistakes(self) -> None:
        response = radiance.sync_detailed(client=CLIENT, body=scene([0, 95], Surface(rms_height_um=-1)))
        self.assertEqual(response.status_code, HTTPStatus.UNPROCESSABLE_ENTITY)
        problem = response.parsed
        assert isinstance(problem, Problem) and not isinstance(problem.errors, Unset)
        pointers = sorted(error.pointer for error in problem.errors)
        self.assertEqual(
            pointers, ["/geometry/theta_r_deg/1", "/surface/correlation_length_um", "/surface/rms_height_um"]
        )

    def test_a_wrong_key(self) -> None:
        stranger = AuthenticatedClient(base_url=os.environ["REFLECTANCE_URL"], token="not-a-key-of-the-service")
        response = roughness.sync_detailed(client=stranger, facet_slope_deg=5)
        if "REFLECTANCE_OPEN" in os.environ:
            # Who asks for no key takes any.
            assert isinstance(response.parsed, Roughness)
        else:
            self.assertEqual(response.status_code, HTTPStatus.UNAUTHORIZED)
            assert isinstance(response.parsed, Problem)


if __name__ == "__main__":
    unittest.main()
