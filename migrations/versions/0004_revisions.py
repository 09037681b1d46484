"""A matrix is asked for its revisions."""

from alembic import op

revision = "0004"
down_revision = "0003"


def upgrade() -> None:
    op.create_index("ix_matrices_parent", "matrices", ["parent"], unique=False)


def downgrade() -> None:
    op.drop_index("ix_matrices_parent", "matrices")
