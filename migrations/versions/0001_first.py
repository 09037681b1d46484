"""The first tables: actuators, matrices, jobs, fits, parameter values, answers."""

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None


def upgrade() -> None:
    op.create_table(
        "actuators",
        sa.Column("serial", sa.String(length=200), nullable=False),
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("batch", sa.String(length=200), nullable=False),
        sa.Column("piston_area", sa.Float(), nullable=True),
        sa.Column("created_at", sa.String(length=40), nullable=False),
        sa.PrimaryKeyConstraint("serial"),
    )
    with op.batch_alter_table("actuators", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_actuators_batch"), ["batch"], unique=False)

    op.create_table(
        "idempotency",
        sa.Column("key", sa.String(length=255), nullable=False),
        sa.Column("fingerprint", sa.String(length=64), nullable=False),
        sa.Column("status", sa.Integer(), nullable=False),
        sa.Column("body", sa.JSON(), nullable=False),
        sa.Column("location", sa.Text(), nullable=False),
        sa.Column("created_at", sa.String(length=40), nullable=False),
        sa.PrimaryKeyConstraint("key"),
    )
    op.create_table(
        "matrices",
        sa.Column("id", sa.String(length=64), nullable=False),
        sa.Column("serial", sa.String(length=200), nullable=False),
        sa.Column("parent", sa.String(length=64), nullable=True),
        sa.Column("created_at", sa.String(length=40), nullable=False),
        sa.Column("source", sa.JSON(), nullable=False),
        sa.Column("summary", sa.JSON(), nullable=False),
        sa.ForeignKeyConstraint(
            ["parent"],
            ["matrices.id"],
        ),
        sa.ForeignKeyConstraint(
            ["serial"],
            ["actuators.serial"],
        ),
        sa.PrimaryKeyConstraint("id"),
    )
    with op.batch_alter_table("matrices", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_matrices_created_at"), ["created_at"], unique=False)
        batch_op.create_index(batch_op.f("ix_matrices_serial"), ["serial"], unique=False)

    op.create_table(
        "fits",
        sa.Column("id", sa.String(length=64), nullable=False),
        sa.Column("matrix", sa.String(length=64), nullable=False),
        sa.Column("serial", sa.String(length=200), nullable=False),
        sa.Column("parent", sa.String(length=64), nullable=True),
        sa.Column("model", sa.String(length=60), nullable=False),
        sa.Column("created_at", sa.String(length=40), nullable=False),
        sa.Column("approved_at", sa.String(length=40), nullable=True),
        sa.Column("current", sa.Boolean(), nullable=False),
        sa.Column("error_fit", sa.Float(), nullable=True),
        sa.Column("error_verify", sa.Float(), nullable=True),
        sa.Column("result", sa.JSON(), nullable=False),
        sa.ForeignKeyConstraint(
            ["matrix"],
            ["matrices.id"],
        ),
        sa.ForeignKeyConstraint(
            ["serial"],
            ["actuators.serial"],
        ),
        sa.PrimaryKeyConstraint("id"),
    )
    with op.batch_alter_table("fits", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_fits_approved_at"), ["approved_at"], unique=False)
        batch_op.create_index(batch_op.f("ix_fits_created_at"), ["created_at"], unique=False)
        batch_op.create_index(batch_op.f("ix_fits_matrix"), ["matrix"], unique=False)
        batch_op.create_index(batch_op.f("ix_fits_serial"), ["serial"], unique=False)

    op.create_table(
        "jobs",
        sa.Column("id", sa.String(length=64), nullable=False),
        sa.Column("kind", sa.String(length=20), nullable=False),
        sa.Column("state", sa.String(length=20), nullable=False),
        sa.Column("matrix", sa.String(length=64), nullable=False),
        sa.Column("parent", sa.String(length=64), nullable=True),
        sa.Column("settings", sa.JSON(), nullable=False),
        sa.Column("progress", sa.JSON(), nullable=False),
        sa.Column("sequence", sa.Integer(), nullable=False),
        sa.Column("cancel", sa.Boolean(), nullable=False),
        sa.Column("problem", sa.JSON(), nullable=True),
        sa.Column("created_at", sa.String(length=40), nullable=False),
        sa.Column("ended_at", sa.String(length=40), nullable=True),
        sa.ForeignKeyConstraint(
            ["matrix"],
            ["matrices.id"],
        ),
        sa.PrimaryKeyConstraint("id"),
    )
    with op.batch_alter_table("jobs", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_jobs_created_at"), ["created_at"], unique=False)
        batch_op.create_index(batch_op.f("ix_jobs_state"), ["state"], unique=False)

    op.create_table(
        "parameter_values",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("fit", sa.String(length=64), nullable=False),
        sa.Column("name", sa.String(length=100), nullable=False),
        sa.Column("value", sa.Float(), nullable=False),
        sa.Column("unit", sa.String(length=60), nullable=False),
        sa.Column("std_error", sa.Float(), nullable=True),
        sa.ForeignKeyConstraint(
            ["fit"],
            ["fits.id"],
        ),
        sa.PrimaryKeyConstraint("id"),
    )
    with op.batch_alter_table("parameter_values", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_parameter_values_fit"), ["fit"], unique=False)
        batch_op.create_index("ix_parameter_values_name_value", ["name", "value"], unique=False)


def downgrade() -> None:
    with op.batch_alter_table("parameter_values", schema=None) as batch_op:
        batch_op.drop_index("ix_parameter_values_name_value")
        batch_op.drop_index(batch_op.f("ix_parameter_values_fit"))

    op.drop_table("parameter_values")
    with op.batch_alter_table("jobs", schema=None) as batch_op:
        batch_op.drop_index(batch_op.f("ix_jobs_state"))
        batch_op.drop_index(batch_op.f("ix_jobs_created_at"))

    op.drop_table("jobs")
    with op.batch_alter_table("fits", schema=None) as batch_op:
        batch_op.drop_index(batch_op.f("ix_fits_serial"))
        batch_op.drop_index(batch_op.f("ix_fits_matrix"))
        batch_op.drop_index(batch_op.f("ix_fits_created_at"))
        batch_op.drop_index(batch_op.f("ix_fits_approved_at"))

    op.drop_table("fits")
    with op.batch_alter_table("matrices", schema=None) as batch_op:
        batch_op.drop_index(batch_op.f("ix_matrices_serial"))
        batch_op.drop_index(batch_op.f("ix_matrices_created_at"))

    op.drop_table("matrices")
    op.drop_table("idempotency")
    with op.batch_alter_table("actuators", schema=None) as batch_op:
        batch_op.drop_index(batch_op.f("ix_actuators_batch"))

    op.drop_table("actuators")
