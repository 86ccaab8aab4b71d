"""Settings every test shares."""

from hypothesis import settings

# A busy machine makes an example slow, not wrong: time is for benchmarks/ to judge.
settings.register_profile("project", deadline=None)
settings.load_profile("project")
