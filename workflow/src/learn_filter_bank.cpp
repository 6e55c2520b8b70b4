// SPDX-License-Identifier: GPL-3.0-or-later
#include "learners.h"
#include "surf/core/error.h"
namespace surf::workflow {
namespace {
void check(const LearnOptions&) {}
Learnt learn(const Lesson&) { throw Unsupported("filter bank", "x", "y"); }
}  // namespace
const Learner filter_bank_learner{"filter-bank", "gradient and curvatures at ten scales (thesis, chapter 6)", check, learn};
}  // namespace surf::workflow
