from tcs_hil.hil.monitor.plot import LABEL_WIDTH, Curve, plot


def drawn(curve: Curve, width: int = 2, height: int = 2) -> list[str]:
    text = plot([curve], width + LABEL_WIDTH, height, 1.0)
    return [line[LABEL_WIDTH:] for line in text.plain.split("\n")]


def test_zero_is_the_lowest_dot_and_the_top_the_highest() -> None:
    assert drawn(Curve([0.0] * 4, "")) == ["⠀⠀", "⣀⣀"]
    assert drawn(Curve([1.0] * 4, "")) == ["⠉⠉", "⠀⠀"]


def test_a_jump_is_drawn_as_a_line_and_not_as_two_points() -> None:
    assert drawn(Curve([0.0, 0.0, 1.0, 1.0], "")) == ["⠀⡏", "⣀⡇"]


def test_the_newest_value_is_at_the_right_edge() -> None:
    assert drawn(Curve([0.0], "")) == ["⠀⠀", "⠀⢀"]


def test_what_is_off_the_scale_stays_on_the_edge() -> None:
    assert drawn(Curve([-5.0, -5.0, 7.0, 7.0], "", dashed=True))[1][0] == "⣀"
    assert drawn(Curve([7.0] * 4, ""))[0] == "⠉⠉"


def test_a_gap_stays_a_gap() -> None:
    assert drawn(Curve([0.0, 0.0, None, None], "")) == ["⠀⠀", "⣀⠀"]


def test_the_scale_is_written_at_the_left() -> None:
    lines = plot([], 20, 3, 150.0).plain.split("\n")
    assert [line[:LABEL_WIDTH] for line in lines] == [" 150 ", "     ", "   0 "]
