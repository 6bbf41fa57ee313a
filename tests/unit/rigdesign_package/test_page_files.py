"""The tools that hold pages against what commands print."""

from tests.builders.page_files import missing_lines, shown


def test_a_command_and_its_output_belong_together() -> None:
    page = "```sh\nrigdesign a 'b c'\n```\n\n```text\nd\n```\n\nwords\n\n```sh\nrigdesign e\n```\n\n```text x\nf\n```\n"
    assert shown(page) == [(["a", "b c"], ["d"]), (["e"], [])]


def test_lines_are_found_in_their_order() -> None:
    output = "one\nvalue 71.52 °C, 57 %\nlast word\n"
    assert missing_lines(["value 71.50 °C, 57 %", "…", "last word"], output) == []
    assert missing_lines(["last word", "one"], output) == ["one"]
    assert missing_lines(["value 73.52 °C, 57 %"], output) == ["value 73.52 °C, 57 %"]
    assert missing_lines(["value 71.52 K, 57 %"], output) == ["value 71.52 K, 57 %"]
    assert missing_lines(["value 71.52 …"], output) == []
