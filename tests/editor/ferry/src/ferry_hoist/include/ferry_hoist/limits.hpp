#pragma once
constexpr double MAX_MASS = 40.0;
