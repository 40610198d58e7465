"""What is no input ends in an exception that says so: no crash, no endless run."""
import math

import pytest

import frames
import topple

NOT_FINITE = [math.nan, -math.nan, math.inf, -math.inf]


def in_circles():
    around, listed = {}, []
    around["title"] = around
    listed.append(listed)
    return [around, {"title": listed}]


@pytest.mark.parametrize("source", in_circles())
def test_what_holds_itself_is_refused(source):
    with pytest.raises(ValueError, match="[Cc]ircular"):
        topple.Model(source)
    with pytest.raises(ValueError, match="[Cc]ircular"):
        topple.Scenario(dict(source, model="seed_building"))
    with pytest.raises(ValueError, match="[Cc]ircular"):
        topple.choice([source])


def test_a_number_that_is_none_is_named_however_deep_the_rest_goes():
    deep = []
    for _ in range(300):
        deep = [deep]
    with pytest.raises(ValueError):
        topple.Model({"deep": deep, "gravity": math.nan})
    with pytest.raises(topple.InputError, match="gravity: found nan"):
        topple.Model({"gravity": math.nan, "deep": deep})


@pytest.mark.parametrize("call", [
    lambda text: topple.Model(text),
    lambda text: topple.Model({"topple": 1, "title": text}),
    lambda text: topple.Scenario(text),
    lambda text: topple.analyse(frames.column({"push": {"x": 1e3}}), text),
    lambda text: topple.analyse(frames.column({"push": {"x": 1e3}}), lose=[text]),
    lambda text: topple.choice([text]),
])
def test_half_a_surrogate_pair_is_no_text(call):
    with pytest.raises(UnicodeEncodeError):
        call("half \ud800")


@pytest.mark.parametrize("until", NOT_FINITE + [-1.0, 1e300])
def test_a_run_goes_to_a_time_that_comes(until):
    run = topple.Simulation("seed_idle")
    with pytest.raises(topple.InputError, match="until"):
        run.run(until=until)
    assert run.steps == 0


@pytest.mark.parametrize("number", NOT_FINITE)
def test_distributions_are_of_finite_numbers(number):
    for of in (topple.grid, topple.choice):
        with pytest.raises(ValueError, match="finite"):
            of([1.0, number])
    with pytest.raises(ValueError, match="share"):
        topple.uniform(0, 1).quantile(number)


def test_a_list_of_values_has_an_end():
    with pytest.raises(ValueError, match="at most"):
        topple.grid(range(10**12))
