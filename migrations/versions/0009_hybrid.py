"""Controllers and hybrid simulations are kept beside the fits that they are of."""

import sqlalchemy as sa
from alembic import op

revision = "0009"
down_revision = "0008"


def upgrade() -> None:
    op.create_table(
        "controllers",
        sa.Column("id", sa.String(length=64), nullable=False),
        sa.Column("fit", sa.String(length=64), nullable=False),
        sa.Column("created_at", sa.String(length=40), nullable=False),
        sa.Column("asked", sa.JSON(), nullable=False),
        sa.Column("result", sa.JSON(), nullable=False),
        sa.ForeignKeyConstraint(["fit"], ["fits.id"]),
        sa.PrimaryKeyConstraint("id"),
    )
    op.create_index("ix_controllers_fit", "controllers", ["fit"])
    op.create_index("ix_controllers_created_at", "controllers", ["created_at"])
    op.create_table(
        "hybrid_simulations",
        sa.Column("id", sa.String(length=64), nullable=False),
        sa.Column("fit", sa.String(length=64), nullable=False),
        sa.Column("matrix", sa.String(length=64), nullable=False),
        sa.Column("serial", sa.String(length=200), nullable=False),
        sa.Column("controller", sa.String(length=64), nullable=True),
        sa.Column("created_at", sa.String(length=40), nullable=False),
        sa.Column("asked", sa.JSON(), nullable=False),
        sa.Column("result", sa.JSON(), nullable=False),
        sa.Column("records", sa.LargeBinary(), nullable=False),
        sa.ForeignKeyConstraint(["fit"], ["fits.id"]),
        sa.ForeignKeyConstraint(["matrix"], ["matrices.id"]),
        sa.ForeignKeyConstraint(["serial"], ["actuators.serial"]),
        sa.ForeignKeyConstraint(["controller"], ["controllers.id"]),
        sa.PrimaryKeyConstraint("id"),
    )
    op.create_index("ix_hybrid_simulations_fit", "hybrid_simulations", ["fit"])
    op.create_index("ix_hybrid_simulations_created_at", "hybrid_simulations", ["created_at"])


def downgrade() -> None:
    op.drop_table("hybrid_simulations")
    op.drop_table("controllers")
