# SPDX-License-Identifier: GPL-3.0-or-later
# An emulated processor is 10 to 20 times slower than this one. Cases (Suite.Case) that match one of these are `long` in a
# build for another processor, and `ctest --preset aarch64` leaves them out: what takes about ten seconds there, but
# for the vector code, and TryThread, because an emulator lets a process have more address space than it may.
set(SEMSURF_TOO_LONG_EMULATED
  "TryThread\\.(IsNotJoinable|LoopsAre).*"
  # libsurf
  "BestTip\\..*"
  "BlindTip\\.OuterThresholdBoundsTheTipInNearlyAllDraws"
  "All/WatchedScan\\..*"
  "(FilterBank|FacetNetwork)\\.IsWatched"
  "EstimateSemNoise\\..*"
  "GuidedEstimate\\..*"
  "MakeSelfAffine\\..*"
  "Reconstruct\\..*"
  "RegisterImages\\..*"
  "RoundTipSearch\\.BoundsATipOnPillarsFromOutside"
  "SampleSurfaces\\..*"
  "SimplifyMesh\\..*"
  "SubstrateNoise\\.IsThatBetweenTheFeatures"
  "TipShapes\\.ManyFacesAreACone"
  "TipSweep\\.FindsAThresholdWhoseTipIsAmongTheBest"
  "ThinHeightField\\..*"
  "UnconstrainedDirections\\..*"
  "WatchedMeshes\\..*"
  # mc_sim
  "CascadeLibrary\\.(IsDistributedAsCascadesAre|TakesNoPageThatLeadsOutOfItself)"
  "Detection\\.(QuadrantsAndWindowsAndConesPartitionTheTotal|EfficiencyScalesYieldAndError)"
  "Dielectric\\..*"
  "DiffusionMatrixTable\\.SecondOrderMomentsAddUpAndTheBarrierHoldsBack"
  "DistanceGrid\\.(Holds.*|IsNeverMoreThanTheDistance)"
  "Dose\\.TheImageHasAMicroscopesNoise"
  "FullPenn.*"
  "LibrarySize\\..*"
  "LossSampler\\..*"
  "Mott\\.(ReproducesTheTransportCrossSections|SamplesTheTablesAroundAnEnergy)"
  "OddCounts\\.(AreHalf|Rounds).*"
  "Pilot\\..*"
  "Replay\\.(Generates|GivesTheSameNumbersWithLosses|HandsOver|Refuses|Reports).*"
  "Scene\\.(Keeps|LeavesOut|LetsThe|LosesNobody|SeesHollows|TreatsFaces).*"
  "SinglePoleSampler\\..*"
  "Spectra\\..*"
  "Beside/SurfaceQueries\\..*"
  "Transport\\.(HasLewisMoments|ReflectsAsChandrasekharComputed)")
