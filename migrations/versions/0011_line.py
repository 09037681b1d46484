"""Sets are numbered and kept apart from the fits that they come from; approvals, limits and regressions are rows."""

import sqlalchemy as sa
from alembic import op

revision = "0011"
down_revision = "0010"

OPEN = sa.text("until IS NULL")
MOVED = ("approved_at", "current", "error_fit", "error_verify")
SETS = """
INSERT INTO parameter_sets
    (fit, serial, batch, model, created_at, error_fit, error_verify, effects, data_hash, seed, version, equations, who)
SELECT f.id, f.serial, a.batch, f.model, f.created_at, f.error_fit, f.error_verify,
    coalesce({effects}, '[]'), coalesce({data_hash}, ''), {seed}, coalesce({version}, ''), '', ''
FROM fits f JOIN actuators a ON a.serial = f.serial ORDER BY f.created_at, f.id
"""
OF_RESULT = {
    "sqlite": {
        "effects": "json_extract(f.result, '$.effects')",
        "data_hash": "json_extract(f.result, '$.data_hash')",
        "seed": "json_extract(f.result, '$.seed')",
        "version": "json_extract(f.result, '$.version')",
    },
    "postgresql": {
        "effects": "f.result->'effects'",
        "data_hash": "f.result->>'data_hash'",
        "seed": "cast(f.result->>'seed' AS integer)",
        "version": "f.result->>'version'",
    },
}
"""Where a set comes from stood in its result."""
VALUES = """
INSERT INTO set_values (number, name, place, value, unit, std_error)
SELECT s.number, v.name, v.id - (SELECT min(w.id) FROM parameter_values w WHERE w.fit = v.fit), v.value, v.unit,
    v.std_error
FROM parameter_values v JOIN parameter_sets s ON s.fit = v.fit
"""
# A set was in force from its approval until the next one of its serial number; the last one is in force as before.
APPROVALS = """
INSERT INTO approvals (serial, number, since, until, who, why)
SELECT f.serial, s.number, f.approved_at, CASE WHEN f.current THEN NULL ELSE coalesce((
        SELECT min(n.approved_at) FROM fits n WHERE n.serial = f.serial AND n.approved_at > f.approved_at
    ), f.approved_at) END, '', ''
FROM fits f JOIN parameter_sets s ON s.fit = f.id WHERE f.approved_at IS NOT NULL ORDER BY f.current, f.approved_at
"""


def upgrade() -> None:
    op.add_column("matrices", sa.Column("batch", sa.String(length=200), nullable=False, server_default=""))
    op.add_column("matrices", sa.Column("piston_area", sa.Float(), nullable=True))
    op.execute("UPDATE matrices SET batch = (SELECT batch FROM actuators WHERE serial = matrices.serial)")
    op.execute("UPDATE matrices SET piston_area = (SELECT piston_area FROM actuators WHERE serial = matrices.serial)")
    op.add_column("jobs", sa.Column("who", sa.String(length=200), nullable=False, server_default=""))
    op.add_column("evolutions", sa.Column("blob", sa.String(length=64), nullable=True))
    _tables()
    dialect = op.get_bind().dialect.name
    op.execute(SETS.format(**OF_RESULT[dialect]))
    op.execute(VALUES)
    op.execute(APPROVALS)
    op.drop_table("parameter_values")
    op.drop_index("ix_fits_approved_at", "fits")
    with op.batch_alter_table("fits") as batch:
        for name in MOVED:
            batch.drop_column(name)


def _tables() -> None:
    op.create_table(
        "parameter_sets",
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("fit", sa.String(length=64), nullable=False),
        sa.Column("serial", sa.String(length=200), nullable=False),
        sa.Column("batch", sa.String(length=200), nullable=False),
        sa.Column("model", sa.String(length=60), nullable=False),
        sa.Column("created_at", sa.String(length=40), nullable=False),
        sa.Column("error_fit", sa.Float(), nullable=True),
        sa.Column("error_verify", sa.Float(), nullable=True),
        sa.Column("effects", sa.JSON(), nullable=False),
        sa.Column("data_hash", sa.String(length=64), nullable=False),
        sa.Column("seed", sa.Integer(), nullable=True),
        sa.Column("version", sa.String(length=40), nullable=False),
        sa.Column("equations", sa.String(length=64), nullable=False),
        sa.Column("who", sa.String(length=200), nullable=False),
        sa.ForeignKeyConstraint(["fit"], ["fits.id"]),
        sa.ForeignKeyConstraint(["serial"], ["actuators.serial"]),
        sa.PrimaryKeyConstraint("number"),
        sa.UniqueConstraint("fit"),
    )
    for column in ("serial", "batch", "model"):
        op.create_index(f"ix_parameter_sets_{column}", "parameter_sets", [column, "number"])
    op.create_table(
        "set_values",
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("name", sa.String(length=100), nullable=False),
        sa.Column("place", sa.Integer(), nullable=False),
        sa.Column("value", sa.Float(), nullable=False),
        sa.Column("unit", sa.String(length=60), nullable=False),
        sa.Column("std_error", sa.Float(), nullable=True),
        sa.ForeignKeyConstraint(["number"], ["parameter_sets.number"]),
        sa.PrimaryKeyConstraint("number", "name"),
        sqlite_with_rowid=False,
    )
    op.create_index("ix_set_values_name_value", "set_values", ["name", "value", "number"])
    op.create_index("ix_set_values_name_number", "set_values", ["name", "number", "value"])
    op.create_table(
        "approvals",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("serial", sa.String(length=200), nullable=False),
        sa.Column("number", sa.Integer(), nullable=True),
        sa.Column("since", sa.String(length=40), nullable=False),
        sa.Column("until", sa.String(length=40), nullable=True),
        sa.Column("who", sa.String(length=200), nullable=False),
        sa.Column("why", sa.Text(), nullable=False),
        sa.ForeignKeyConstraint(["serial"], ["actuators.serial"]),
        sa.ForeignKeyConstraint(["number"], ["parameter_sets.number"]),
        sa.PrimaryKeyConstraint("id"),
    )
    for name, columns, only in (
        ("in_force", ["serial"], OPEN),
        ("number_in_force", ["number"], OPEN),
        ("number", ["number"], None),
        ("serial", ["serial", "id"], None),
        ("since", ["since", "number"], None),
    ):
        where = {} if only is None else {"sqlite_where": only, "postgresql_where": only}
        op.create_index(f"ix_approvals_{name}", "approvals", columns, unique=name == "in_force", **where)
    op.create_table(
        "limits",
        sa.Column("model", sa.String(length=60), nullable=False),
        sa.Column("batch", sa.String(length=200), nullable=False),
        sa.Column("name", sa.String(length=100), nullable=False),
        sa.Column("lower", sa.Float(), nullable=True),
        sa.Column("upper", sa.Float(), nullable=True),
        sa.Column("unit", sa.String(length=60), nullable=False),
        sa.Column("who", sa.String(length=200), nullable=False),
        sa.Column("changed_at", sa.String(length=40), nullable=False),
        sa.PrimaryKeyConstraint("model", "batch", "name"),
    )
    op.create_table(
        "regressions",
        sa.Column("id", sa.String(length=64), nullable=False),
        sa.Column("asked", sa.JSON(), nullable=False),
        sa.Column("tolerance", sa.Float(), nullable=False),
        sa.Column("who", sa.String(length=200), nullable=False),
        sa.Column("created_at", sa.String(length=40), nullable=False),
        sa.PrimaryKeyConstraint("id"),
    )
    op.create_table(
        "rechecks",
        sa.Column("id", sa.String(length=64), nullable=False),
        sa.Column("regression", sa.String(length=64), nullable=False),
        sa.Column("fit", sa.String(length=64), nullable=False),
        sa.Column("serial", sa.String(length=200), nullable=False),
        sa.Column("seconds", sa.Float(), nullable=True),
        sa.Column("changes", sa.JSON(), nullable=True),
        sa.ForeignKeyConstraint(["id"], ["jobs.id"]),
        sa.ForeignKeyConstraint(["regression"], ["regressions.id"]),
        sa.ForeignKeyConstraint(["fit"], ["fits.id"]),
        sa.ForeignKeyConstraint(["serial"], ["actuators.serial"]),
        sa.PrimaryKeyConstraint("id"),
    )
    op.create_index("ix_rechecks_regression", "rechecks", ["regression"])


def downgrade() -> None:
    """Evolutions that are blobs are lost to the version before, and so is who approved when."""
    op.create_table(
        "parameter_values",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("fit", sa.String(length=64), nullable=False),
        sa.Column("name", sa.String(length=100), nullable=False),
        sa.Column("value", sa.Float(), nullable=False),
        sa.Column("unit", sa.String(length=60), nullable=False),
        sa.Column("std_error", sa.Float(), nullable=True),
        sa.ForeignKeyConstraint(["fit"], ["fits.id"]),
        sa.PrimaryKeyConstraint("id"),
    )
    op.create_index("ix_parameter_values_fit", "parameter_values", ["fit"])
    op.create_index("ix_parameter_values_name_value", "parameter_values", ["name", "value"])
    op.execute(
        "INSERT INTO parameter_values (fit, name, value, unit, std_error) SELECT s.fit, v.name, v.value, v.unit, "
        "v.std_error FROM set_values v JOIN parameter_sets s ON s.number = v.number ORDER BY v.number, v.place"
    )
    with op.batch_alter_table("fits") as batch:
        batch.add_column(sa.Column("approved_at", sa.String(length=40), nullable=True))
        batch.add_column(sa.Column("current", sa.Boolean(), nullable=False, server_default=sa.false()))
        batch.add_column(sa.Column("error_fit", sa.Float(), nullable=True))
        batch.add_column(sa.Column("error_verify", sa.Float(), nullable=True))
    op.create_index("ix_fits_approved_at", "fits", ["approved_at"])
    of = "FROM parameter_sets s LEFT JOIN approvals a ON a.number = s.number WHERE s.fit = fits.id"
    op.execute(
        f"UPDATE fits SET approved_at = (SELECT min(a.since) {of}), error_fit = (SELECT max(s.error_fit) {of}), "
        f"error_verify = (SELECT max(s.error_verify) {of}), current = EXISTS (SELECT 1 {of} AND a.id IS NOT NULL "
        "AND a.until IS NULL)"
    )
    op.execute("DELETE FROM evolutions WHERE blob IS NOT NULL")
    with op.batch_alter_table("evolutions") as batch:
        batch.drop_column("blob")
    for table in ("rechecks", "regressions", "limits", "approvals", "set_values", "parameter_sets"):
        op.drop_table(table)
    with op.batch_alter_table("jobs") as batch:
        batch.drop_column("who")
    with op.batch_alter_table("matrices") as batch:
        batch.drop_column("piston_area")
        batch.drop_column("batch")
