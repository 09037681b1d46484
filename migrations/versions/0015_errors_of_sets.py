"""Sets have their error with the mean counted, and the runs on which their model is unstable, as their results say."""

import sqlalchemy as sa
from alembic import op

revision = "0015"
down_revision = "0014"

UNSTABLE = 1e3  # the error, eq. (17), from which on a model counted as unstable on a run when this was written
USES = ("fit", "verify")
FILL = "UPDATE parameter_sets SET " + ", ".join(
    f"error_with_mean_{use} = (SELECT {{with_mean_{use}}} FROM fits f WHERE f.id = parameter_sets.fit), "
    f"unstable_{use} = (SELECT {{unstable_{use}}})"
    for use in USES
)
WITH_MEAN = {
    "sqlite": "coalesce(json_extract(f.result, '$.error_with_mean.{use}'), "
    "json_extract(f.result, '$.anchored_error.{use}'))",
    "postgresql": "cast(coalesce(f.result->'error_with_mean'->>'{use}', f.result->'anchored_error'->>'{use}') "
    "AS double precision)",
}
"""Earlier versions had it under another name, and the first ones not at all."""
RUNS = {
    "sqlite": "SELECT json_group_array(json_extract(r.value, '$.id')) FROM fits f, json_each(f.result, '$.runs') r "
    "WHERE f.id = parameter_sets.fit AND json_extract(r.value, '$.use') = '{use}' "
    "AND json_extract(r.value, '$.error') >= {limit} AND NOT EXISTS (SELECT 1 "
    "FROM json_each(f.result, '$.left_out') l WHERE l.value = json_extract(r.value, '$.id'))",
    "postgresql": "SELECT coalesce(json_agg(r.value->>'id' ORDER BY r.ordinality), '[]') FROM fits f, "
    "json_array_elements(f.result->'runs') WITH ORDINALITY r "
    "WHERE f.id = parameter_sets.fit AND r.value->>'use' = '{use}' "
    "AND cast(r.value->>'error' AS double precision) >= {limit} AND NOT EXISTS (SELECT 1 "
    "FROM json_array_elements_text(f.result->'left_out') l WHERE l.value = r.value->>'id')",
}
"""A run that was left out of the fit is in no error, and so is not named."""


def upgrade() -> None:
    for use in USES:
        op.add_column("parameter_sets", sa.Column(f"error_with_mean_{use}", sa.Float(), nullable=True))
        none = sa.Column(f"unstable_{use}", sa.JSON(), nullable=False, server_default="[]")
        op.add_column("parameter_sets", none)
    dialect = op.get_bind().dialect.name
    filled = {f"with_mean_{use}": WITH_MEAN[dialect].format(use=use) for use in USES}
    filled |= {f"unstable_{use}": f"({RUNS[dialect].format(use=use, limit=UNSTABLE)})" for use in USES}
    op.execute(FILL.format(**filled))


def downgrade() -> None:
    with op.batch_alter_table("parameter_sets") as batch:
        for use in USES:
            batch.drop_column(f"unstable_{use}")
            batch.drop_column(f"error_with_mean_{use}")
