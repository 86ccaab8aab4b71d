"""Settings every test shares."""

from hypothesis import Phase, settings

# A busy machine makes an example slow, not wrong: time is for benchmarks/ to judge.
settings.register_profile("project", deadline=None)
# For whoever runs the tests some hundred times over: the same few examples, left as they are found.
settings.register_profile(
    "brief",
    deadline=None,
    max_examples=20,
    derandomize=True,
    database=None,
    phases=(Phase.explicit, Phase.generate),
)
settings.load_profile("project")
