"""What makes a printed report a document: who prepared it, for what, and when it was issued."""

from dataclasses import dataclass, field
from datetime import date

from rigdesign.report.case_sheet import CaseSheet
from rigdesign.results.result import RunResult


@dataclass(frozen=True, kw_only=True)
class Issue:
    """One issue of a report.

    date : the one thing of the page that differs between two runs of one case, apart from computing times
    author : in place of ``document.author`` of the case
    """

    date: date = field(default_factory=date.today)
    author: str = ""


@dataclass(frozen=True, kw_only=True)
class Signatures:
    """What stands in and above the block of signatures; empty where the case says nothing."""

    project: str
    number: str
    prepared: str
    checked: str
    approved: str


def signatures(result: RunResult, issue: Issue) -> Signatures:
    """From the table ``document`` of the case."""
    document = CaseSheet.of(result.inputs).table("document")
    return Signatures(
        project=document.raw("project"),
        number=document.raw("number"),
        prepared=issue.author or document.raw("author"),
        checked=document.raw("checked_by"),
        approved=document.raw("approved_by"),
    )
