! Calls the UMAT of a path of strains of a cube, as a program would that knows nothing else: 40 increments in six components.
program driver
   implicit none
   character(len=80) :: name = 'USER'
   integer :: step, c, whole(4) = (/1, 1, 0, 0/)
   double precision :: stress(6) = 0, states(1) = 0, tangent(6, 6), energy(3) = 0, heat, by_t(6), by_e(6), by, strain(6) = 0, &
                       increment(6), time(2) = 0, dtime, zero(3) = 0, one(3, 3), share, length = 1, constants(4), before(6), now(6)
   constants = (/200d0, 0.3d0, 0.4d0, 20d0/)
   one = 0
   do c = 1, 3
      one(c, c) = 1
   end do
   dtime = 1d0/40
   before = 0
   do step = 1, 40
      call path(step/40d0, now)
      increment = now - before
      share = 1
      call umat(stress, states, tangent, energy(1), energy(2), energy(3), heat, by_t, by_e, by, strain, increment, time, dtime, zero, &
                zero, zero, zero, name, 3, 3, 6, 1, constants, 4, zero, one, share, length, one, one, 1, 1, 1, 1, whole, step)
      strain = now
      before = now
      time = time + dtime
      print '(7es25.16)', stress, states
   end do
contains
   subroutine path(t, e)
      double precision, intent(in) :: t
      double precision, intent(out) :: e(6)
      e = (/0.01d0*sin(6*t), -0.004d0*t, 0.003d0*sin(9*t), 0.012d0*t*(1 - t), 0.006d0*sin(5*t), -0.008d0*t/)
   end subroutine path
end program driver
