"""When the work of a job began, and the course that it took: by them the time that others have left is estimated."""

import sqlalchemy as sa
from alembic import op

revision = "0020"
down_revision = "0019"


def upgrade() -> None:
    op.add_column("jobs", sa.Column("began_at", sa.String(length=40), nullable=True))
    op.add_column("jobs", sa.Column("course", sa.JSON(), nullable=False, server_default="[]"))
    op.create_index("ix_jobs_kind_ended", "jobs", ["kind", "state", "ended_at"])


def downgrade() -> None:
    op.drop_index("ix_jobs_kind_ended", "jobs")
    with op.batch_alter_table("jobs") as table:
        table.drop_column("course")
        table.drop_column("began_at")
