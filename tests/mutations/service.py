"""Defects of the service: jobs, idempotency, who may ask, what a query finds, what is rechecked."""

from tests.mutations.mutation import Mutation

_SERVICE = "tests/app/test_service.py"
_WEBHOOKS = ("tests/app/webhooks/test_webhooks.py",)
_SECURITY = ("tests/app/test_security.py",)

SERVICE = (
    Mutation("same-key", "app/idempotency/answers.py", "if row.fingerprint != asked:", "if row.fingerprint == asked:",
             "another request under a key is answered", (f"{_SERVICE}::test_the_same_key_is_answered_once",)),
    Mutation("how-it-ended", "app/jobs/steps.py", 'state = last["outcome"] or "succeeded"', 'state = "succeeded"',
             "whatever ends is called a success", (f"{_SERVICE}::test_a_running_job_is_cancelled_and_leaves_no_fit",)),
    Mutation("foreign-origin", "app/security.py", 'origin.partition("://")[2] not in self.hosts',
             'not origin.partition("://")[2]', "any page may post", _SECURITY),
    Mutation("token", "app/access/identity.py", "if not shown.cookie and same(shown.text, context.settings.token):",
             "if not shown.cookie:", "any token is right", _SECURITY),
    Mutation("approved-after", "app/parameters/repository/conditions.py", "row.since > bindparam(",
             "row.since < bindparam(", "sets approved before are found",
             (f"{_SERVICE}::test_an_approved_set_is_what_the_production_line_finds",)),
    Mutation("range", "app/parameters/repository/conditions.py", "of_name.where(ValueRow.value.between(lower, upper))",
             "of_name.where(ValueRow.value.between(lower, lower))", "of a range only its end is found",
             ("tests/app/test_size.py::test_pages_have_every_set_once_and_the_newest_first",)),
    Mutation("current-set", "app/tables/sets.py", "any(approval.until is None for",
             "any(approval.until for", "an approved set is not in force",
             (f"{_SERVICE}::test_an_approved_set_is_what_the_production_line_finds",
              "tests/cli/test_service_commands.py")),
    Mutation("recheck", "app/regress/recheck.py", "self.relative > tolerance and told",
             "self.relative > 100 * tolerance and told", "a per cent for a tenth of a per mille",
             ("tests/app/test_recheck.py",)),
    Mutation("line-apart", "app/access/audited_changes.py", 'and "apart" not in session.info:',
             'and "apart" in session.info:', "a change is committed without its line of the audit",
             ("tests/app/access/test_audit.py::test_a_change_leaves_one_line_and_is_none_without_it",)),
    Mutation("unsigned-time", "app/webhooks/signing.py", 'b"%d." % timestamp + body', "body",
             "what was recorded is genuine for ever", _WEBHOOKS),
    Mutation("redirect", "app/webhooks/sending.py", "follow_redirects=False", "follow_redirects=True",
             "a receiver sends the service elsewhere", _WEBHOOKS),
    Mutation("two-couriers", "app/webhooks/repository.py", "WebhookRow.leased_until <= moment, waits", "waits",
             "two processes send to one webhook at once", _WEBHOOKS),
    Mutation("raw-in-force", "app/retention/repository.py", "_approval(ApprovalRow.until.is_(None) |", "_approval(",
             "raw runs of a set in force are removed", ("tests/app/retention/test_rule.py",)),
)  # fmt: skip
"""Defects of the service."""
