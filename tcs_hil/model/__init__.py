"""The belief: wheel dynamics, tyre, and the Koopman predictor identified from them."""
