"""A failure as RFC 9457 has it, with what, where and the remedy."""

from pydantic import BaseModel


class Problem(BaseModel):
    """A problem document; `detail` says what is wrong, `where` where, `remedy` what to do."""

    type: str
    title: str
    status: int
    code: str
    detail: str
    where: str = ""
    remedy: str = ""
