# SPDX-License-Identifier: GPL-3.0-or-later
# An emulated processor is 10 to 20 times slower than this one. Cases (Suite.Case) that match one of these are `long` in a
# build for another processor, and `ctest --preset aarch64` leaves them out: what takes more than ten seconds there, but
# for the vector code, and TryThread, because an emulator lets a process have more address space than it may.
set(SEMSURF_TOO_LONG_EMULATED
  "TryThread\\.(IsNotJoinable|LoopsAre).*"
  # libsurf
  "BestTip\\..*"
  "BlindTip\\.OuterThresholdBoundsTheTipInNearlyAllDraws"
  "EstimateSemNoise\\..*"
  "Reconstruct\\..*"
  "RegisterImages\\..*"
  "RoundTipSearch\\.BoundsATipOnPillarsFromOutside"
  "SampleSurfaces\\..*"
  "SimplifyMesh\\..*"
  "SubstrateNoise\\.IsThatBetweenTheFeatures"
  "TipShapes\\.ManyFacesAreACone"
  "TipSweep\\.FindsAThresholdWhoseTipIsAmongTheBest"
  "UnconstrainedDirections\\..*"
  # mc_sim
  "Beside/SurfaceQueries\\..*"
  "CascadeLibrary\\.(IsDistributedAsCascadesAre|TakesNoPageThatLeadsOutOfItself)"
  "Detection\\.(QuadrantsAndWindowsAndConesPartitionTheTotal|EfficiencyScalesYieldAndError)"
  "Dielectric\\..*"
  "DiffusionMatrixTable\\.SecondOrderMomentsAddUpAndTheBarrierHoldsBack"
  "DistanceGrid\\.Holds.*"
  "Dose\\.TheImageHasAMicroscopesNoise"
  "FullPenn.*"
  "LibrarySize\\..*"
  "LossSampler\\..*"
  "Mott\\.(ReproducesTheTransportCrossSections|SamplesTheTablesAroundAnEnergy)"
  "Pilot\\..*"
  "Replay\\.GeneratesAsManySecondariesAsTracksFollowedToTheirEnd"
  "Scene\\.(KeepsElectronsWhereTheirMaterialIs|LosesNobodyOnClosedBodies)"
  "Scene\\.LeavesOutWhatNoElectronReachesAndChangesNothing"
  "SinglePoleSampler\\..*"
  "Transport\\.(HasLewisMoments|ReflectsAsChandrasekharComputed)")
