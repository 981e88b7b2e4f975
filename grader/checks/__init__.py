"""Facts about one submission. A check knows no points and no lab: names, frames and numbers come from the rubric."""
