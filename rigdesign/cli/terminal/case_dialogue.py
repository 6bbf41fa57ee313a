"""Questions of `rigdesign new case` in a terminal: an answer that cannot be is said and asked for again at once."""

from collections.abc import Callable, Iterable, Mapping
from typing import TypeVar

from rigdesign.base.errors import UsageError
from rigdesign.base.units import QuantityError
from rigdesign.cli.exit_status import NOTHING_KEPT, interrupted
from rigdesign.new_case.outline import QUESTIONS, AnswersError, Question, read_answer

T = TypeVar("T")


def ask_for_case(given: Mapping[str, str], make: Callable[[dict[str, str]], T]) -> T:
    """Ask for what is not given, then for what ``make`` refuses, until it makes a case.

    Parameters
    ----------
    given : answers of the command line by key
    make : makes the case of all answers; raises AnswersError for those that do not fit each other

    Raises
    ------
    UsageError
        The input ends before all questions are answered, or no other answer could mend what is wrong.
    """
    with interrupted(NOTHING_KEPT):
        answers = _asked((question for question in QUESTIONS if question.key not in given), given)
        while True:
            try:
                return make(answers)
            except AnswersError as error:
                if not error.keys:
                    raise
                print(f"{error}\nAnswer again; an empty line keeps the answer in brackets.")
                answers = _asked((question for question in QUESTIONS if question.key in error.keys), answers)


def _asked(questions: Iterable[Question], known: Mapping[str, str]) -> dict[str, str]:
    """``known`` with the answers to ``questions``; a question without an answer is left out."""
    answers = dict(known)
    for question in questions:
        answer = _answer(question, answers.get(question.key))
        if answer:
            answers[question.key] = answer
    return answers


def _answer(question: Question, kept: str | None) -> str:
    """A readable answer to one question; empty where none is needed. ``kept`` counts for an empty line."""
    empty = ", empty to leave it out" if not (question.required or kept) else ""
    prompt = f"{question.asked} (e.g. {question.example}{empty}){f' [{kept}]' if kept else ''}: "
    while True:
        try:
            answer = input(prompt).strip() or kept or ""
        except EOFError:
            problem = f"no answer to {question.flag}: the input has ended"
            raise UsageError(f"no case was written: {problem}; give it on the command line") from None
        if not answer and not question.required:
            return ""
        try:
            read_answer(question, answer)
        except QuantityError as error:
            print(f"  {error}")
        else:
            return answer
