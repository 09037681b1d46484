"""What a feedforward is worth, in the contract's words; SI where no unit is."""

from pydantic import BaseModel


class FeedforwardView(BaseModel):
    """How the machine follows the reference with the feedback alone and with the feedforward (`both`), errors in m.

    `gain` and `limit` (null: none), from which the loop is unstable, in V/m; `drawn_*` are medians of `draws` machines
    drawn from the fitted covariance, null without standard errors. Curves over `t` (s); 90 % of the draws lie between
    `low` and `high`.
    """

    gain: float
    limit: float | None
    draws: int
    feedback_rms: float
    both_rms: float
    drawn_feedback_rms: float | None
    drawn_both_rms: float | None
    drawn_ratio: float | None
    t: list[float]
    reference: list[float]
    feedback: list[float]
    both: list[float]
    low: list[float]
    high: list[float]
