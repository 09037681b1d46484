"""Diagnoses; jobs are found by the fit that they start from."""

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"


def upgrade() -> None:
    op.create_table(
        "diagnoses",
        sa.Column("id", sa.String(length=64), nullable=False),
        sa.Column("matrix", sa.String(length=64), nullable=False),
        sa.Column("serial", sa.String(length=200), nullable=False),
        sa.Column("fit", sa.String(length=64), nullable=False),
        sa.Column("created_at", sa.String(length=40), nullable=False),
        sa.Column("result", sa.JSON(), nullable=False),
        sa.ForeignKeyConstraint(["matrix"], ["matrices.id"]),
        sa.ForeignKeyConstraint(["serial"], ["actuators.serial"]),
        sa.ForeignKeyConstraint(["fit"], ["fits.id"]),
        sa.PrimaryKeyConstraint("id"),
    )
    op.create_index("ix_diagnoses_fit", "diagnoses", ["fit"], unique=False)
    op.create_index("ix_diagnoses_created_at", "diagnoses", ["created_at"], unique=False)
    op.create_index("ix_jobs_parent", "jobs", ["parent"], unique=False)


def downgrade() -> None:
    op.drop_index("ix_jobs_parent", "jobs")
    op.drop_table("diagnoses")
