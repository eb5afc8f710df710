"""What a user writes, with the types that the type checker must find (`make lint`). Nothing of it is run."""

from typing import TYPE_CHECKING, assert_type

if TYPE_CHECKING:
    import xarray as xr

    import roughcoat as rc
    import solver

    contact = rc.solve(P=[1e-5, 2e-5], h="2 um", R="5 mm", body="steel 52100")
    assert_type(contact, xr.Dataset)
    assert_type(rc.decode(contact.status), xr.DataArray)
    assert_type(rc.design({"p0": 0.01}, by={"h": (1e-3, 0.1)}, P=1e-5, n=0.5, micro="smooth"), xr.Dataset)
    assert_type(rc.feasible(contact, p0="< 1 GPa", validity=0), xr.DataArray)
    assert_type(rc.front(contact, least=["p0", "D"]), xr.Dataset)
    assert_type(rc.load("mine").open(), xr.Dataset)
    assert_type(rc.open_results("results/mine.nc"), xr.Dataset)
    assert_type(rc.to_physical(contact, R="5 mm", E2_star=2e11), xr.Dataset)
    assert_type(rc.materials.get("PTFE").E, float)
    assert_type(rc.derived.nominal_area_ratio(contact, 0.1), xr.DataArray)
    assert_type(rc.roughness.measure(rc.roughness.read("scan.csv", unit="um")), rc.roughness.Roughness)
    assert_type(rc.__version__, str)
    answer = solver.solve(solver.Problem.of(P=[1e-5], base="half_space", micro="smooth"), x=[0.0, 0.5])
    assert_type(answer, solver.Solution)
    assert_type(solver.fit_power_law(4.0), solver.Fit)
    assert_type(solver.closed_forms.hertz(P=1.0), solver.closed_forms.SmoothContact)
    assert_type(solver.Status.CONVERGED.meaning, str)
