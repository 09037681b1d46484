"""Defects of the service: jobs, idempotency, who may ask, what a query finds, what is rechecked."""

from tests.mutations.mutation import Mutation

_SERVICE = "tests/app/test_service.py"
_SECURITY = ("tests/app/test_security.py",)

SERVICE = (
    Mutation("same-key", "app/idempotency/answers.py", "if row.fingerprint != asked:", "if row.fingerprint == asked:",
             "another request under a key is answered", (f"{_SERVICE}::test_the_same_key_is_answered_once",)),
    Mutation("how-it-ended", "app/jobs/steps.py", 'state = last["outcome"] or "succeeded"', 'state = "succeeded"',
             "whatever ends is called a success", (f"{_SERVICE}::test_a_running_job_is_cancelled_and_leaves_no_fit",)),
    Mutation("foreign-origin", "app/security.py", 'origin.partition("://")[2] not in self.hosts',
             'not origin.partition("://")[2]', "any page may post", _SECURITY),
    Mutation("token", "app/security.py", "if self._right(bearer) or self._right(cookie):",
             "if bearer or self._right(cookie):", "any token is right", _SECURITY),
    Mutation("approved-after", "app/parameters/repository.py", "FitRow.approved_at > wanted.approved_after",
             "FitRow.approved_at < wanted.approved_after", "sets approved before are found",
             (f"{_SERVICE}::test_an_approved_set_is_what_the_production_line_finds",)),
    Mutation("range", "app/parameters/repository.py", "ValueRow.value >= wanted.lowest[name]",
             "ValueRow.value <= wanted.lowest[name]", "values below a range are found",
             ("tests/cli/test_service_commands.py",)),
    Mutation("current-set", "app/fits/repository.py", "row.current, row.approved_at = True,",
             "row.current, row.approved_at = False,", "an approved set is not in force",
             (f"{_SERVICE}::test_an_approved_set_is_what_the_production_line_finds",
              "tests/cli/test_service_commands.py")),
    Mutation("recheck", "app/regress/recheck.py", "if change.relative > self.tolerance)",
             "if change.relative > 100 * self.tolerance)", "a per cent for a tenth of a per mille",
             ("tests/app/test_recheck.py",)),
)  # fmt: skip
"""Defects of the service."""
