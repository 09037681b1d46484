"""Jobs are found by their matrix, and so by its actuator."""

from alembic import op

revision = "0002"
down_revision = "0001"


def upgrade() -> None:
    op.create_index("ix_jobs_matrix", "jobs", ["matrix"], unique=False)


def downgrade() -> None:
    op.drop_index("ix_jobs_matrix", "jobs")
