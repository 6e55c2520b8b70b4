// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/core/error.h"

#include <gtest/gtest.h>

namespace surf {

TEST(Error, WhatJoinsSubjectReasonAndRemedy) {
  const UsageError error("`scan.size`", "is 0", "Give 1 or more");
  EXPECT_STREQ(error.what(), "`scan.size`: is 0. Give 1 or more");
  EXPECT_EQ(error.subject(), "`scan.size`");
  EXPECT_EQ(error.reason(), "is 0");
  EXPECT_EQ(error.remedy(), "Give 1 or more");
}

TEST(Error, EmptyPartsLeaveNoPunctuation) {
  EXPECT_STREQ(FileError("a.off", "cannot be opened", "").what(), "a.off: cannot be opened");
  EXPECT_STREQ(InvalidInput("", "nothing was given", "").what(), "nothing was given");
}

TEST(Error, KindsAreDistinctAndShareTheBase) {
  const auto thrown = [] { throw Unsupported("file.vti", "this build has no VTK", "Use EXR"); };
  EXPECT_THROW(thrown(), Error);
  EXPECT_THROW(thrown(), Unsupported);
  try {
    thrown();
  } catch (const FileError&) {
    FAIL() << "an Unsupported is not a FileError";
  } catch (const Error&) {
  }
}

}  // namespace surf
