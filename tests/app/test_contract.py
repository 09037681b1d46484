"""Whatever is asked within the served OpenAPI document, by whomever: no 5xx, no undocumented status or type."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

import pytest
from fastapi.testclient import TestClient
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from tests.short_form import short_form

if TYPE_CHECKING:
    from schemathesis import APIOperation

EXAMPLES, MORE = 1, 100  # of each operation by the admin; with --full
OTHERS, MORE_OTHERS = 1, 60  # by each of the other roles, and by nobody
Headers = dict[str, str]


@pytest.fixture(scope="module")
def operations(service: TestClient) -> list[APIOperation]:
    """What the document has; requests are drawn for all roles from what is made of each once."""
    import schemathesis  # here: each worker collects this file, and one makes the requests

    schema = schemathesis.openapi.from_dict(service.get("/api/v1/openapi.json").json())
    found = [operation.ok() for operation in schema.get_all_operations()]
    # A stream lasts as long as its job; it has tests of its own.
    return [operation for operation in found if not operation.path.endswith("/events")]


def test_fuzzed_requests_stay_within_the_document(
    service: TestClient, operations: list[APIOperation], matrix: str, full: bool
) -> None:
    """By the admin, who may do everything."""
    headers = {"Authorization": service.headers["Authorization"]}
    tried = _tried(service, operations, headers, matrix, MORE if full else EXAMPLES)
    assert set(tried) > {200, 404, 422}


@pytest.mark.parametrize("role", short_form(["lab", "line", "ci", ""], ""))
def test_fuzzed_requests_of_each_role_do_too(
    service: TestClient, operations: list[APIOperation], matrix: str, full: bool, role: str
) -> None:
    """What a role may not is refused however it is asked; nobody gets anything but whether the service is well."""
    asked = {"name": f"fuzzing {role}", "role": role}
    headers = {"Authorization": f"Bearer {service.post('/api/v1/tokens', json=asked).json()['token']}"} if role else {}
    tried = _tried(service, operations, headers, matrix, MORE_OTHERS if full else OTHERS)
    assert (tried[403] > 2) is bool(role)
    assert (tried[401] > 50) is not bool(role)


def _tried(
    service: TestClient, operations: list[APIOperation], headers: Headers, matrix: str, examples: int
) -> Counter[int]:
    """How often each status was answered."""
    statuses: Counter[int] = Counter()
    for operation in operations:
        _attempts(service, operation, headers, matrix, examples, statuses)()
    assert len(operations) >= 50
    print(f"{statuses.total()} requests: {dict(sorted(statuses.items()))}")
    return statuses


def _attempts(
    service: TestClient,
    operation: APIOperation,
    who: Headers,
    matrix: str,
    examples: int,
    statuses: Counter[int],
) -> Callable[[], None]:
    from schemathesis.checks import not_a_server_error
    from schemathesis.specs.openapi.checks import content_type_conformance, status_code_conformance

    checks = [not_a_server_error, status_code_conformance, content_type_conformance]

    @settings(
        max_examples=examples, deadline=None, derandomize=True, database=None, suppress_health_check=list(HealthCheck)
    )
    @given(st.data())
    def attempt(data: st.DataObject) -> None:
        case = data.draw(operation.as_strategy())
        if case.path_parameters and "matrix" in case.path_parameters:
            case.path_parameters["matrix"] = data.draw(st.sampled_from([matrix, case.path_parameters["matrix"]]))
        request = case.as_transport_kwargs(base_url="http://127.0.0.1:8000")
        request.pop("cookies", None)
        assume(_can_be_sent(request.get("files") or ()))
        headers = {**(request.pop("headers", None) or {}), "Authorization": "", **who}
        answer = service.request(**request, headers=headers)
        statuses[answer.status_code] += 1
        answer.request.read()  # it may have been refused before it was read, and the checks show it
        case.validate_response(answer, checks=checks)

    return attempt


def _can_be_sent(files: Iterable[tuple[str, object]]) -> bool:
    """Whether the client of the tests can write each part: it fails on a number before anything is asked."""
    contents = [part[1] if isinstance(part, tuple) else part for _, part in files]
    return all(isinstance(content, str | bytes) for content in contents)


@pytest.mark.parametrize(
    "path", ["/api/v1/nothing", "/api/v1/fits/%00", "/api/v1/jobs/%F0%9F%98%80", "/api/v1/fits/a/b"]
)
def test_a_path_that_is_not_there_is_a_problem_document(service: TestClient, path: str) -> None:
    answer = service.get(path)
    assert answer.status_code == 404
    assert answer.headers["content-type"] == "application/problem+json"
