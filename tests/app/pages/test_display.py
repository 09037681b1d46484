"""Pages and figures come in the display units of the cookie; JSON stays in SI."""

from __future__ import annotations

API = "/api/v1"
IMPERIAL = {"Cookie": "units=in%2Clb"}


def test_pages_and_figures_come_in_the_units_of_the_cookie_and_json_in_si(service, matrix, fitted):
    """The same figure is asked for in both: neither is the other from memory."""
    plain, shown = (service.get(f"/fits/{fitted}", headers=headers).text for headers in ({}, IMPERIAL))
    assert [" lb" in text for text in (plain, shown)] == [False, True]
    runs = [service.get(f"/matrices/{matrix}", headers=headers).text for headers in ({}, IMPERIAL)]
    assert [" lb" in text for text in runs] == [False, True]
    for _ in range(2):
        for headers, unit in (({}, "m)"), (IMPERIAL, "in)")):
            at = f"{API}/matrices/{matrix}/figures/signals.json?live=1"
            params = service.get(at, headers=headers).json()["params"]
            axes = [param["value"][1] for param in params if param["name"].startswith("across")]
            assert axes
            assert all(axis.endswith(unit) for axis in axes)
    assert service.get(f"{API}/fits/{fitted}", headers=IMPERIAL).json() == service.get(f"{API}/fits/{fitted}").json()


def test_a_cookie_that_names_no_units_changes_nothing(service, fitted):
    plain = service.get(f"/fits/{fitted}").text
    for cookie in ("units=nonsense", "units=", "units=%00", 'units="bar'):
        assert service.get(f"/fits/{fitted}", headers={"Cookie": cookie}).text == plain
